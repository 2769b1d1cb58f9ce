"""Test misconceptions in motions."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import Symbol, Vocabulary, read
from dh_grader.grading import FeedbackLevel, PartReport
from dh_grader.grading.diagnosis import motions as link_products
from dh_grader.grading.diagnosis import products as motion_slips
from dh_grader.grading.diagnosis.motions import Chain, GivenMotion, LinkPose, named
from dh_grader.grading.misconception import Written, WrongNumbers
from dh_grader.grading.report import Finding
from dh_grader.kinematics import Matrices, Numbers, about
from dh_grader.translations import say

from tests.grading.diagnosis.pairs import (
    A1,
    A2,
    A3,
    A4,
    CHAIN,
    POSE,
    Pair,
    X,
    Z,
    assert_explains_only_the_first,
    each_pair,
    product,
)
from tests.grading.support.submitting import Make, all_codes, full_marks, handed_in, one_part, part

# --- Test slips in a product of several motions

COUNT = 8
RNG = np.random.default_rng(21)
VALUES = {name: RNG.uniform(0.3, 1.2, COUNT) for name in ("phi", "psi", "a", "b", "l", "k")}
WORDS = Vocabulary([Symbol(name, "angle" if len(name) > 1 else "length") for name in VALUES])


def step(displacement: tuple[str, str, str], axis: str, angle: str) -> Matrices:
    motion = np.tile(np.eye(4), (COUNT, 1, 1))
    motion[:, :3, :3] = about(axis, VALUES[angle]) if angle else np.eye(3)
    motion[:, :3, 3] = np.transpose(
        [VALUES[name] if name else np.zeros(COUNT) for name in displacement]
    )
    return motion


# Along x and z, a turn about z; along y, a turn about x; along z. H1 and H2 are from a lecture.
H1, H2, H3 = (
    step(("a", "", "b"), "Z", "phi"),
    step(("", "l", ""), "X", "psi"),
    step(("", "", "k"), "X", ""),
)
RIGHT = H1 @ H2 @ H3
TRANSFORM = [
    ["cφ", "-sφ cψ", "sφ sψ", "a - l sφ + k sφ sψ"],
    ["sφ", "cφ cψ", "-cφ sψ", "l cφ - k cφ sψ"],
    ["0", "sψ", "cψ", "b + k cψ"],
    ["0", "0", "0", "1"],
]
MOTION = GivenMotion(
    tuple(tuple(read(text, WORDS) for text in row) for row in TRANSFORM),
    VALUES,
    COUNT,
    ("phi", "psi"),
    ("a", "b", "l", "k"),
)


def wrong(actual: Numbers, right: Numbers) -> WrongNumbers:
    actual, right = np.moveaxis(actual, 0, -1), np.moveaxis(right, 0, -1)
    return WrongNumbers(actual, right, np.ones(right.shape[:-1]))


def position(actual: Numbers) -> WrongNumbers:
    return wrong(actual, RIGHT[:, :3, 3])


def rotation(actual: Numbers) -> WrongNumbers:
    return wrong(actual[:, :3, :3], RIGHT[:, :3, :3])


def turned(matrix: Matrices, vector: Numbers) -> Numbers:
    return np.asarray((matrix[:, :3, :3] @ vector[..., None])[..., 0])


D1, D2, D3 = H1[:, :3, 3], H2[:, :3, 3], H3[:, :3, 3]
FROM_LEFT, FROM_RIGHT = H3 @ H2 @ H1, H1 @ H3 @ H2
PAIRS = [
    Pair(
        motion_slips.steps_in_reverse,
        wrong(FROM_LEFT[:, :3], RIGHT[:, :3]),
        wrong(FROM_RIGHT[:, :3], RIGHT[:, :3]),
        "reversed_product",
    ),
    Pair(motion_slips.turns_in_another_order, rotation(H2 @ H1), rotation(H1), "reversed_product"),
    Pair(motion_slips.turn_left_out, rotation(H2), rotation(H2 @ H1), "missing_turn"),
    Pair(
        motion_slips.turn_reversed,
        rotation(H1[:, :3, :3] @ np.swapaxes(H2[:, :3, :3], 1, 2)),
        rotation(np.swapaxes(RIGHT[:, :3, :3], 1, 2)),
        "turn_sign",
    ),
    Pair(
        motion_slips.displacement_not_turned,
        position(D1 + turned(H1, D2) + turned(H2, D3)),
        position(D1 + turned(H1, D2)),
    ),
    Pair(
        motion_slips.missing_displacement,
        position(D1 + turned(H1 @ H2, D3)),
        position(D1 + D3),
    ),
    Pair(
        motion_slips.lone_displacement,
        position(turned(H1, D3)),
        position(D1 + D3),
        "missing_displacement",
    ),
]
PAIRS = [pair._replace(source=lambda _: MOTION) for pair in PAIRS]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_the_motion_is_found_in_the_formulas() -> None:
    assert MOTION.order == ("phi", "psi")
    assert [(each.lengths, each.angles) for each in MOTION.displacements] == [
        (("a", "b"), ()),
        (("l",), ("phi",)),
        (("k",), ("phi", "psi")),
    ]
    assert MOTION.steps is not None
    for found, given in zip(MOTION.steps, (H1, H2, H3), strict=True):
        assert np.allclose(found, given)


SYMBOLS = """
[symbols]
phi = { kind = "angle", description = "a turn about z" }
psi = { kind = "angle", description = "a turn about x" }
a = { kind = "length", description = "along x" }
b = { kind = "length", description = "along z" }
l = { kind = "length", description = "along y" }
k = { kind = "length", description = "along z again" }
"""
AS_TRANSFORM = one_part("transform", f"expected = {TRANSFORM}", SYMBOLS)
AS_POSITION = one_part("position", f"expected = {[row[3] for row in TRANSFORM[:3]]}", SYMBOLS)
NUMBERS = ["0.5 - 0.3 sφ", "0.3 cφ", "0.2"]
WITH_NUMBERS = one_part("position", f"expected = {NUMBERS}", SYMBOLS)
# The position, the code, and words of the message.
POSITIONS: dict[str, tuple[list[str], str, str]] = {
    "d1 + d2 + d3": (["a", "l", "b + k"], "displacement_not_turned", "l is not turned by phi"),
    "d1 + R1 d2 + d3": (
        ["a - l sφ", "l cφ", "b + k"], "displacement_not_turned", "k is not turned by psi",
    ),
    "d1 + R1 d2 + R2 d3": (
        ["a - l sφ", "l cφ - k sψ", "b + k cψ"],
        "displacement_not_turned",
        "k is not turned by phi",
    ),
    "d1 + R1 d2": (["a - l sφ", "l cφ", "b"], "missing_displacement", "motion 3"),
    "R1 d2 + R1 R2 d3": (
        ["k sφ sψ - l sφ", "l cφ - k cφ sψ", "k cψ"], "missing_displacement", "motion 1",
    ),
    "d3 alone": (["0", "0", "k"], "missing_displacement", "motion 3 alone"),
    "d1 alone": (["a", "0", "b"], "missing_displacement", "motion 1 alone"),
}  # fmt: skip


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"it": answer}, feedback=FeedbackLevel.HINTS), "it")


@pytest.mark.parametrize("name", POSITIONS)
@pytest.mark.parametrize("text", [AS_TRANSFORM, AS_POSITION], ids=["transform", "position"])
def test_a_slip_in_three_motions_is_named(text: str, name: str, make_exercise: Make) -> None:
    answer, code, said = POSITIONS[name]
    rows: object = answer
    if text is AS_TRANSFORM:
        upper = [[*row[:3], number] for row, number in zip(TRANSFORM[:3], answer, strict=True)]
        rows = [*upper, TRANSFORM[3]]
    report = graded(make_exercise(text), rows)
    [message] = report.feedback
    assert message.code == code
    assert said in message.message
    assert all_codes(report) == {code}


def test_motions_in_reverse_order_are_named(make_exercise: Make) -> None:
    # The answer is the product H3 H2 H1, multiplied out by hand.
    answer = [
        ["cφ", "-sφ", 0, "a"],
        ["cψ sφ", "cψ cφ", "-sψ", "l - b sψ"],
        ["sψ sφ", "sψ cφ", "cψ", "k + b cψ"],
        [0, 0, 0, 1],
    ]
    exercise = make_exercise(AS_TRANSFORM)
    assert all_codes(graded(exercise, answer)) == {"reversed_product"}
    assert full_marks(graded(exercise, TRANSFORM))


def test_displacements_in_numbers_are_named(make_exercise: Make) -> None:
    exercise = make_exercise(WITH_NUMBERS)
    assert full_marks(graded(exercise, NUMBERS))
    report = graded(exercise, ["0.5", "0.3", "0.2"])
    assert all_codes(report) == {"displacement_not_turned"}
    assert "the displacement is not turned by phi" in report.feedback[0].message
    # A position of zeros does not show which displacements it contains.
    assert "displacement_not_turned" not in all_codes(graded(exercise, ["0", "0", "0"]))


def test_displacements_that_are_only_added_are_named(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["rigid-motion-chain"]
    report = part(handed_in(exercise, {"origin": ["l1", "l2", "h"]}), "origin")
    [message] = report.feedback
    assert message.code == "displacement_not_turned"
    assert "l2 is not turned by phi" in message.message


AS_ROTATION = one_part("rotation", f"expected = {[row[:3] for row in TRANSFORM[:3]]}", SYMBOLS)
CONSTANT = one_part(
    "transform",
    'expected = [["1", "0", "0", "a"], '
    + repr(
        [
            ["0", "1", "0", "0"],
            ["0", "0", "1", "0"],
            ["0", "0", "0", "1"],
        ]
    )[1:],
    SYMBOLS,
)


def test_a_rotation_and_a_shift_have_only_their_own_slips(make_exercise: Make) -> None:
    # A rotation has no displacements, and a shift has no turns.
    exercise = make_exercise(AS_ROTATION)
    turned = [["cφ", "-sφ", "0"], ["sφ", "cφ", "0"], ["0", "0", "1"]]
    assert all_codes(graded(exercise, turned)) == {"missing_turn"}
    assert "value" in all_codes(graded(exercise, [["2 cφ", *row[1:3]] for row in TRANSFORM[:3]]))
    wrong = [["1", "0", "0", "2 a"], *([str(int(i == j)) for j in range(4)] for i in (1, 2, 3))]
    assert all_codes(graded(make_exercise(CONSTANT), wrong)) == {"value"}
    turned = [
        ["0", "1", "0", "a"],
        ["1", "1", "0", "0"],
        ["0", "0", "1", "0"],
        ["0", "0", "0", "1"],
    ]
    assert "value" in all_codes(graded(make_exercise(CONSTANT), turned))


# --- Test the misconceptions about a product of link transforms


@dataclass(frozen=True)
class WrongPose:
    """A wrong pose; the correct pose is ``POSE``."""

    actual: Numbers

    def explained_by(self, hypotheses: Iterable[LinkPose]) -> list[LinkPose]:
        return [each for each in hypotheses if np.allclose(each.answer, self.actual)]


def chain(_case: WrongPose) -> Chain:
    return CHAIN


MODIFIED = [x @ z for z, x in zip(Z, X, strict=True)]
LINK_PRODUCTS_PAIRS = [
    Pair(function, WrongPose(explained), WrongPose(unexplained), source=chain)
    for function, explained, unexplained in (
        (link_products.reversed_product, product(A4, A3, A2, A1), product(A4, A3, A1, A2)),
        (link_products.other_convention, product(*MODIFIED), product(A1, *MODIFIED[1:])),
        (link_products.wrong_frame, product(A1, A2), A2),
        (link_products.wrong_base, product(A3, A4), A3),
        (link_products.missing_link, product(A1, A2, A4), product(A1, A2, A3)),
        (link_products.premultiplied, product(A3, A1, A2, A4), product(A1, A3, A2, A4)),
        (link_products.row_order, product(A2, A3, A1, A4), product(A2, A1, A3, A4)),
    )
]


@each_pair(LINK_PRODUCTS_PAIRS)
def test_a_misconception_explains_only_its_product(pair: Pair) -> None:
    assert not np.allclose(pair.explained.actual, POSE)
    assert_explains_only_the_first(pair)


def test_all_links_multiplied_from_the_left_are_explained() -> None:
    poses = [pose.answer for pose in link_products.premultiplied(CHAIN)]
    assert np.allclose(poses[-1], product(*MODIFIED[::-1]))


def test_the_name_of_a_pose_is_put_into_a_sentence() -> None:
    hint = say("{pose}. {advice}", pose="the pose of frame {2}", advice="Go on.")
    pose = Written(POSE, Finding("wrong_frame", hint))
    [other, finding] = named(pose, "This matrix is {pose}. {advice}", Finding("sign", "Wrong."))()
    assert other.hint == "Wrong."
    assert finding.hint == "This matrix is the pose of frame {2}. Go on."
