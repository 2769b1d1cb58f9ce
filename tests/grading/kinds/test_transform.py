"""Grade transforms, inverse poses and home poses."""

from collections.abc import Mapping
from typing import Any

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.exercise_texts import SPATIAL_RRR, Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part

# The planar RPR arm by product of exponentials.
RPR = [
    ["c13", "-s13", "0", "(L1 + theta2) c1 + L2 c13"],
    ["s13", "c13", "0", "(L1 + theta2) s1 + L2 s13"],
    ["0", "0", "1", "0"],
    ["0", "0", "0", "1"],
]
HOME = [[1, 0, 0, "L1 + L2"], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


@pytest.fixture
def rpr(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["planar-rpr-poe"]


def test_the_poses_of_the_lecture_are_right(rpr: Exercise) -> None:
    report = handed_in(rpr, {"home": HOME, "pose": RPR, "position": [RPR[0][3], RPR[1][3]]})
    for part_id in ("home", "pose", "position"):
        assert full_marks(part(report, part_id)), part(report, part_id)


# The exponentials of the planar RPR arm, by hand.
one, three = sp.symbols("theta1 theta3")
two, l1, l2 = sp.symbols("theta2 L1 L2")


def planar(angle: Any, x: Any, y: Any) -> Any:
    c, s = sp.cos(angle), sp.sin(angle)
    return sp.Matrix([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])


def about(angle: Any, x: Any) -> Any:
    # Return the turn about the axis along z through (x, 0, 0).
    return planar(angle, x - x * sp.cos(angle), -x * sp.sin(angle))


E1, E2, E3 = about(one, 0), planar(0, two, 0), about(three, l1)
M = planar(0, l1 + l2, 0)


def entries(matrix: Any) -> list[list[str]]:
    return [[str(matrix[i, j]) for j in range(4)] for i in range(4)]


def test_the_product_by_hand_is_right(rpr: Exercise) -> None:
    assert full_marks(part(handed_in(rpr, {"pose": entries(E1 * E2 * E3 * M)}), "pose"))


@pytest.mark.parametrize(
    ("matrix", "code"),
    [
        (M * E1 * E2 * E3, "home_on_wrong_side"),
        (E1 * E2 * E3, "missing_home"),
        (E3 * E2 * E1 * M, "reversed_product"),
        (E1 * E2 * about(three, -l1) * M, "moment_sign"),
    ],
)
def test_another_product_is_named(matrix: Any, code: str, rpr: Exercise) -> None:
    report = part(handed_in(rpr, {"pose": entries(matrix)}), "pose")
    assert all_codes(report) == {code}
    assert report.verdict is Verdict.PARTIAL


def test_a_transform_given_by_the_exercise_is_right(catalogue: Mapping[str, Exercise]) -> None:
    inverse = [
        ["cos(phi)", "sin(phi)", "0", "-px cos(phi) - py sin(phi)"],
        ["-sin(phi)", "cos(phi)", "0", "px sin(phi) - py cos(phi)"],
        ["0", "0", "1", "-pz"],
        ["0", "0", "0", "1"],
    ]
    exercise = catalogue["homogeneous-inverse"]
    assert full_marks(part(handed_in(exercise, {"about-z": inverse}), "about-z"))
    inverse[0][3], inverse[1][3] = "-px", "-py"
    report = part(handed_in(exercise, {"about-z": inverse}), "about-z")
    assert set(not_correct(report)) == {("1", "4"), ("2", "4")}
    not_inverted = [
        ["cos(phi)", "-sin(phi)", "0", "px"],
        ["sin(phi)", "cos(phi)", "0", "py"],
        ["0", "0", "1", "pz"],
        ["0", "0", "0", "1"],
    ]
    report = part(handed_in(exercise, {"about-z": not_inverted}), "about-z")
    assert all_codes(report) == {"inverse_transform"}


def test_the_inverse_of_a_robots_pose_is_right(make_exercise: Make) -> None:
    exercise = make_exercise(
        one_part("transform", 'from = 2\nto = "base"\nhome = true', SPATIAL_RRR)
    )
    # Frame 2 of the spatial RRR at home: x out, y up, z along −y0, at R + L1.
    answer = [[1, 0, 0, "-R - L1"], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
    assert full_marks(graded(exercise, answer))


def test_an_unexplained_product_is_reported_entry_by_entry(rpr: Exercise) -> None:
    report = part(handed_in(rpr, {"pose": entries(E1 * E2 * about(three, l2) * M)}), "pose")
    assert set(not_correct(report)) == {("1", "4"), ("2", "4")}
    assert all_codes(report).isdisjoint(
        {"home_on_wrong_side", "missing_home", "reversed_product", "moment_sign"}
    )


@pytest.mark.parametrize("first", ["0", "", None])
def test_a_pose_that_no_joint_moves_earns_nothing_with_an_empty_entry(
    catalogue: Mapping[str, Exercise], first: str | None
) -> None:
    # The tool points down, which is the only constant in the rotation of the RRRP arm.
    pose = [[first, 0, 0, 0], [0, 0, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]
    report = part(handed_in(catalogue["rrrp"], {"pose": pose}), "pose")
    assert "no_joint_variable" in {message.code for message in report.feedback}
    assert report.points == 0
