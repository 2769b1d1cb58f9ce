"""Test misconceptions in products of matrices."""

import re
from collections.abc import Mapping
from functools import reduce
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.diagnosis import products as exponentials
from dh_grader.grading.diagnosis import products as link_slips
from dh_grader.grading.diagnosis import products as rotation_steps
from dh_grader.grading.diagnosis.motions import MatrixCase
from dh_grader.grading.diagnosis.products import Exponentials, LinkAmongOthers, Step
from dh_grader.grading.misconception import explanation
from dh_grader.kinematics import Convention, Numbers
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from tests.frame_choice.kinematics import screw_x, screw_z
from tests.grading.diagnosis.pairs import (
    A1,
    A2,
    A3,
    COUNT,
    TABLE,
    Pair,
    assert_explains_only_the_first,
    each_pair,
    wrong_matrix,
)
from tests.grading.support.robots import A1 as SCARA_A1
from tests.grading.support.robots import A2 as SCARA_A2
from tests.grading.support.robots import A3 as SCARA_A3
from tests.grading.support.robots import A4 as SCARA_A4
from tests.grading.support.robots import SCARA_EXERCISE as SCARA
from tests.grading.support.robots import graded
from tests.grading.support.submitting import Make, all_codes, handed_in, part

# --- Test slips in a link transform

ANGLES = [np.linspace(0.2, 0.9, COUNT), np.linspace(1.1, -0.4, COUNT)]
ZERO = np.zeros(COUNT)
LINKS = np.array([A1, A2, A3])
STANDARD = LinkAmongOthers(LINKS, ANGLES, Convention.STANDARD)
# The third row in the modified convention: first about and along x, then about and along z.
THIRD = screw_x(*TABLE[2, :2]) @ screw_z(*TABLE[2, 2:])
MODIFIED = LinkAmongOthers(np.array([A1, A2, THIRD]), ANGLES, Convention.MODIFIED)
# The rotation of a link, with a and d of the table as its position.
BESIDE = A3.copy()
BESIDE[:, :3, 3] = np.stack([TABLE[2, 0], ZERO, TABLE[2, 2]], axis=-1)
PAIRS = [
    Pair(
        link_slips.absolute_angle,
        wrong_matrix(screw_z(ZERO, ANGLES[0] + ANGLES[1]) @ A3, A3),
        wrong_matrix(A3 @ screw_z(ZERO, ANGLES[0] + ANGLES[1]), A3),
        source=lambda _: STANDARD,
    ),
    Pair(
        link_slips.absolute_angle,
        wrong_matrix(THIRD @ screw_z(ZERO, ANGLES[1]), THIRD),
        wrong_matrix(screw_z(ZERO, ANGLES[1]) @ THIRD, THIRD),
        source=lambda _: MODIFIED,
    ),
    Pair(
        link_slips.pose_for_link,
        wrong_matrix(A1 @ A2 @ A3, A3),
        wrong_matrix(A2 @ A3, A3),
        source=lambda _: STANDARD,
    ),
    Pair(
        link_slips.translation_not_turned,
        wrong_matrix(BESIDE, A3),
        wrong_matrix(BESIDE @ screw_x(TABLE[2, 0], ZERO), A3),
        source=lambda _: STANDARD,
    ),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def matrix(angle: str, length: str, of_length: str) -> list[list[Any]]:
    return [
        [f"c{angle}", f"-s{angle}", 0, f"{length} c{of_length}"],
        [f"s{angle}", f"c{angle}", 0, f"{length} s{of_length}"],
        [0, 0, 1, 0],
        [0, 0, 0, 1],
    ]


@pytest.mark.parametrize(
    ("second", "wrong"),
    [(matrix("12", "a2", "12"), 6), (matrix("12", "a2", "2"), 4), (matrix("2", "a2", "12"), 2)],
    ids=["whole", "rotation", "position"],
)
def test_a_second_link_with_both_angles_is_named(
    second: list[list[Any]], wrong: int, catalogue: Mapping[str, Exercise]
) -> None:
    answer = [matrix("1", "a1", "1"), second]
    report = part(handed_in(catalogue["planar-rr"], {"links": answer}), "links")
    [message] = report.feedback
    assert (message.code, len(message.places or ())) == ("absolute_angle", wrong)
    assert all_codes(report) == {"absolute_angle"}


def test_a_pose_for_the_second_link_is_named(catalogue: Mapping[str, Exercise]) -> None:
    pose = matrix("12", "a2", "12")
    pose[0][3], pose[1][3] = "a1 c1 + a2 c12", "a1 s1 + a2 s12"
    answer = [matrix("1", "a1", "1"), pose]
    report = part(handed_in(catalogue["planar-rr"], {"links": answer}), "links")
    assert all_codes(report) == {"pose_for_link"}


def test_two_links_with_the_same_slip_get_one_message(make_exercise: Make) -> None:
    # In the answer, A2 of a SCARA arm is also turned by θ1, and A4 by θ1 + θ2.
    second = [[re.sub(r"([cs])2", r"\g<1>12", text) for text in row] for row in SCARA_A2]
    turn = "theta1 + theta2 + theta4"
    last = [
        [text.replace("c4", f"cos({turn})").replace("s4", f"sin({turn})") for text in row]
        for row in SCARA_A4
    ]
    exercise = make_exercise(SCARA)
    right = graded(exercise, links=[SCARA_A1, SCARA_A2, SCARA_A3, SCARA_A4])["links"]
    assert all_codes(right) == set()
    report = graded(exercise, links=[SCARA_A1, second, SCARA_A3, last])["links"]
    [message] = report.feedback
    assert message.code == "absolute_angle"
    assert {place.row[:2] for place in message.places or ()} == {"A2", "A4"}


# --- Test the misconceptions about a product of rotations

ROTATION_STEPS_ANGLES = np.random.default_rng(12).uniform(0.2, 1.4, (3, COUNT))


def turn(axis: str, angles: Numbers) -> Numbers:
    """Return the rotations by ``angles`` about "x", "y" or "z"."""
    return np.asarray(Rotation.from_euler(axis, angles[:, None]).as_matrix())


X, Y, Z = (turn(axis, angles) for axis, angles in zip("xyz", ROTATION_STEPS_ANGLES, strict=True))
# Turns about the fixed x axis, the fixed y axis and the moving z axis: Y X Z.
STEPS = [Step("X", X, fixed=True), Step("Y", Y, fixed=True), Step("Z", Z, fixed=False)]


def wrong(*factors: Numbers) -> MatrixCase:
    return wrong_matrix(reduce(np.matmul, factors), Y @ X @ Z)


def steps(_case: MatrixCase) -> list[Step]:
    return STEPS


ROTATION_STEPS_PAIRS = [
    Pair(
        rotation_steps.fixed_for_moving,
        wrong(X, Y, Z),
        wrong(Y, Z, X),
        "fixed_for_moving_axes",
        steps,
    ),
    Pair(
        rotation_steps.turned_back,
        wrong(Y, turn("x", -ROTATION_STEPS_ANGLES[0]), Z),
        wrong(Y, turn("x", -2 * ROTATION_STEPS_ANGLES[0]), Z),
        "turn_sign",
        steps,
    ),
    Pair(
        rotation_steps.about_another_axis,
        wrong(Y, turn("z", ROTATION_STEPS_ANGLES[0]), Z),
        wrong(Y, turn("z", ROTATION_STEPS_ANGLES[1]), Z),
        "turn_axis",
        steps,
    ),
    Pair(
        rotation_steps.by_another_angle,
        wrong(Y, turn("x", ROTATION_STEPS_ANGLES[2]), turn("z", ROTATION_STEPS_ANGLES[0])),
        wrong(Y, turn("z", ROTATION_STEPS_ANGLES[0]), Z),
        "turn_angle",
        steps,
    ),
    Pair(rotation_steps.another_order, wrong(Y, Z, X), wrong(Y, Z), "reversed_product", steps),
    Pair(rotation_steps.left_out, wrong(Y, Z), wrong(Z, Y), "missing_turn", steps),
]


@each_pair(ROTATION_STEPS_PAIRS)
def test_a_misconception_explains_only_its_rotation(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


@pytest.mark.parametrize(
    ("factors", "said"),
    [
        (
            (turn("y", -ROTATION_STEPS_ANGLES[1]), turn("x", -ROTATION_STEPS_ANGLES[0]), Z),
            "Turns 1 and 2 go the wrong way",
        ),
        ((Z,), "Turns 1 and 2 are missing"),
        ((Y, turn("x", ROTATION_STEPS_ANGLES[1]), Z), "Turn 1 was made by the angle of turn 2"),
        (
            (Y, turn("x", ROTATION_STEPS_ANGLES[2]), turn("z", ROTATION_STEPS_ANGLES[0])),
            "The angles of turns 1 and 3",
        ),
    ],
)
def test_several_wrong_turns_are_named(factors: tuple[Numbers, ...], said: str) -> None:
    found = explanation(wrong(*factors), STEPS, Step)
    assert found is not None
    assert found.findings[0].hint.startswith(said)


# --- Test the misconceptions about a product of exponentials

RNG = np.random.default_rng(13)
AMOUNTS = RNG.uniform(0.3, 1.2, (3, COUNT))
HOME = np.broadcast_to(np.eye(4), (COUNT, 4, 4)).copy()
HOME[:, :3, 3] = RNG.uniform(0.3, 0.9, (COUNT, 3))
# Two turning joints through points away from the origin, and a sliding one between them.
AXES = [[0, 0, 1, 0, -0.5, 0], [0, 0, 0, 1, 0, 0], [1, 0, 0, 0, 0, 0.7]]
SPACE = np.repeat(np.array(AXES, dtype=float)[:, None], COUNT, axis=1)


def twist(axis: Numbers) -> Numbers:
    """Return the 4×4 matrix of a screw axis (ω; v)."""
    x, y, z, *velocity = axis
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    matrix[:3, 3] = velocity
    return matrix


def exponential(axes: Numbers, amounts: Numbers) -> Numbers:
    pairs = zip(axes, amounts, strict=True)
    return np.array([expm(twist(axis) * amount) for axis, amount in pairs])


E1, E2, E3 = (exponential(axes, amounts) for axes, amounts in zip(SPACE, AMOUNTS, strict=True))
TURNED_MOMENT = [exponential(SPACE[i] * [1, 1, 1, -1, -1, -1], AMOUNTS[i]) for i in (0, 2)]


def body() -> Numbers:
    # Return the screw axes, seen from the tool frame in the home position.
    back = np.linalg.inv(HOME)
    matrices = np.array([[twist(axis) for axis in axes] for axes in SPACE])
    seen = back @ matrices @ HOME
    omega = seen[..., [2, 0, 1], [1, 2, 0]]
    return np.concatenate([omega, seen[..., :3, 3]], axis=-1)


def product(_case: MatrixCase) -> Exponentials:
    return Exponentials(SPACE, body(), AMOUNTS, HOME)


def exponentials_wrong(*factors: Numbers) -> MatrixCase:
    return wrong_matrix(reduce(np.matmul, factors), E1 @ E2 @ E3 @ HOME)


EXPONENTIALS_PAIRS = [
    Pair(
        exponentials.home_on_the_wrong_side,
        exponentials_wrong(HOME, E1, E2, E3),
        exponentials_wrong(E1, HOME, E2, E3),
        "home_on_wrong_side",
        product,
    ),
    Pair(
        exponentials.missing_home,
        exponentials_wrong(E1, E2, E3),
        exponentials_wrong(E1, E2),
        source=product,
    ),
    Pair(
        exponentials.reversed_product,
        exponentials_wrong(E3, E2, E1, HOME),
        exponentials_wrong(E2, E1, E3, HOME),
        source=product,
    ),
    Pair(
        exponentials.moment_sign,
        exponentials_wrong(TURNED_MOMENT[0], E2, TURNED_MOMENT[1], HOME),
        exponentials_wrong(TURNED_MOMENT[0], E2, E3, HOME),
        source=product,
    ),
]


@each_pair(EXPONENTIALS_PAIRS)
def test_a_misconception_explains_only_its_exponentials(pair: Pair) -> None:
    assert_explains_only_the_first(pair)
