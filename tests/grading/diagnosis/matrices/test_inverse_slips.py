"""Test the misconceptions about the inverse of a homogeneous transform."""

from collections.abc import Mapping

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import FeedbackLevel, PartReport
from dh_grader.grading.diagnosis import matrices as inverse_slips
from dh_grader.grading.diagnosis.motions import MatrixCase
from dh_grader.kinematics import Numbers

from tests.grading.diagnosis.example_chain import POSE, wrong_matrix
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.grading.support.exercise_texts import Make, all_codes, one_part
from tests.grading.support.submitting import handed_in, part

R, P = POSE[:, :3, :3], POSE[:, :3, 3]
BACK = np.swapaxes(R, 1, 2)
TURNED: Numbers = (BACK @ P[..., None])[..., 0]
RIGHT: Numbers = np.asarray(np.linalg.inv(POSE), dtype=np.float64)


def case(rotation: Numbers, position: Numbers) -> MatrixCase:
    matrix = RIGHT.copy()
    matrix[:, :3, :3], matrix[:, :3, 3] = rotation, position
    return wrong_matrix(matrix, RIGHT)


PAIRS = [
    Pair(
        inverse_slips.transposed_for_inverse,
        wrong_matrix(np.swapaxes(POSE, 1, 2), RIGHT),
        wrong_matrix(np.swapaxes(RIGHT, 1, 2), RIGHT),
    ),
    Pair(inverse_slips.negated_for_inverse, case(-R, -P), case(-R, P)),
    Pair(
        inverse_slips.negated_rotation, case(-R, -TURNED), case(R, -TURNED), "negated_for_inverse"
    ),
    Pair(inverse_slips.position_not_turned, case(BACK, -P), case(BACK, P)),
    Pair(inverse_slips.position_not_inverted, case(BACK, P), case(BACK, -P)),
    Pair(inverse_slips.position_reversed, case(BACK, TURNED), case(BACK, -P), "reversed_position"),
    Pair(
        inverse_slips.position_turned_back,
        case(BACK, -(R @ P[..., None])[..., 0]),
        case(BACK, TURNED),
    ),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


# The inverse of Rot_x(phi) Trans(a, 0, b), which no exercise has: [Rᵀ, −(a, 0, b)]; and of a
# transform in numbers, Rot_z(90°) with p = (3, 1, 2): −Rᵀp = (−1, 3, −2).
SYMBOLS = """
[symbols]
phi = { kind = "angle", description = "a turn" }
px = { kind = "length", description = "x" }
py = { kind = "length", description = "y" }
pz = { kind = "length", description = "z" }
"""
ABOUT_X = one_part(
    "transform",
    """expected = [
    ["1", "0", "0", "-px"],
    ["0", "cos(phi)", "sin(phi)", "-py*cos(phi) - pz*sin(phi)"],
    ["0", "-sin(phi)", "cos(phi)", "py*sin(phi) - pz*cos(phi)"],
    ["0", "0", "0", "1"],
]""",
    SYMBOLS,
)
IN_NUMBERS = one_part(
    "transform",
    """expected = [
    ["0", "1", "0", "-1"], ["-1", "0", "0", "3"], ["0", "0", "1", "-2"], ["0", "0", "0", "1"],
]""",
    SYMBOLS,
)
X_TURNED = [["1", "0", "0"], ["0", "cφ", "-sφ"], ["0", "sφ", "cφ"]]
X_BACK = [["1", "0", "0"], ["0", "cφ", "sφ"], ["0", "-sφ", "cφ"]]
Z_TURNED = [["0", "-1", "0"], ["1", "0", "0"], ["0", "0", "1"]]
Z_BACK = [["0", "1", "0"], ["-1", "0", "0"], ["0", "0", "1"]]
Answer = tuple[str, list[list[str]], list[str], str]
WRONG: dict[str, Answer] = {
    "−p": (ABOUT_X, X_BACK, ["-px", "-py", "-pz"], "position_not_turned"),
    "p": (ABOUT_X, X_BACK, ["px", "py", "pz"], "position_not_inverted"),
    "no minus": (ABOUT_X, X_BACK, ["px", "py cφ + pz sφ", "pz cφ - py sφ"], "reversed_position"),
    "−R p": (ABOUT_X, X_BACK, ["-px", "pz sφ - py cφ", "-py sφ - pz cφ"], "position_turned_back"),
    "R, −p": (ABOUT_X, X_TURNED, ["-px", "-py", "-pz"], "negated_for_inverse"),
    "−p in numbers": (IN_NUMBERS, Z_BACK, ["-3", "-1", "-2"], "position_not_turned"),
    "p in numbers": (IN_NUMBERS, Z_BACK, ["3", "1", "2"], "position_not_inverted"),
    "no minus in numbers": (IN_NUMBERS, Z_BACK, ["1", "-3", "2"], "reversed_position"),
    "R, −p in numbers": (IN_NUMBERS, Z_TURNED, ["-3", "-1", "-2"], "negated_for_inverse"),
    "T in numbers": (IN_NUMBERS, Z_TURNED, ["3", "1", "2"], "inverse_transform"),
}


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"it": answer}, feedback=FeedbackLevel.HINTS), "it")


@pytest.mark.parametrize("name", WRONG)
def test_a_slip_in_an_inverse_gets_one_message(name: str, make_exercise: Make) -> None:
    text, rotation, position, code = WRONG[name]
    upper = [[*row, number] for row, number in zip(rotation, position, strict=True)]
    answer = [*upper, ["0", "0", "0", "1"]]
    assert all_codes(graded(make_exercise(text), answer)) == {code}
    if text is IN_NUMBERS:
        bare = make_exercise(text.replace(SYMBOLS, ""))
        assert all_codes(graded(bare, answer)) == {code}


def test_the_transpose_gets_one_message(make_exercise: Make) -> None:
    upper = [[*row, "0"] for row in X_BACK]
    report = graded(make_exercise(ABOUT_X), [*upper, ["px", "py", "pz", "1"]])
    assert all_codes(report) == {"transposed_for_inverse"}


def test_an_inverse_with_the_position_only_negated_is_named(
    catalogue: Mapping[str, Exercise],
) -> None:
    rotation = [["cφ", "sφ", "0"], ["-sφ", "cφ", "0"], ["0", "0", "1"]]
    upper = [[*row, p] for row, p in zip(rotation, ["-px", "-py", "-pz"], strict=True)]
    report = handed_in(catalogue["homogeneous-inverse"], {"about-z": [*upper, [0, 0, 0, 1]]})
    [message] = part(report, "about-z").feedback
    assert message.code == "position_not_turned"
    assert {place.cell for place in message.places or ()} == {"4"}
