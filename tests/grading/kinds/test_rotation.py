"""Grade rotation matrices."""

from collections.abc import Mapping
from typing import Any

import pytest
import sympy as sp
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.exercise_texts import SPATIAL_RRR, Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part

phi, theta, psi = sp.symbols("phi theta psi")


def turn(axis: str, angle: Any) -> Any:
    """Return the elementary rotation about an axis."""
    # Source: *Direct Kinematics (Part 2)*, §1.4.
    c, s = sp.cos(angle), sp.sin(angle)
    return {
        "x": sp.Matrix([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": sp.Matrix([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def entries(matrix: Any) -> list[list[str]]:
    return [[str(matrix[i, j]) for j in range(3)] for i in range(3)]


Z, X, Y = turn("z", phi), turn("x", theta), turn("y", psi)
COMPOSITES = {"fixed": Y * X * Z, "mobile": Z * X * Y, "mixed": Y * Z * X}


@pytest.mark.parametrize("axis", "xyz")
def test_the_fundamental_rotations_are_right(axis: str, catalogue: Mapping[str, Exercise]) -> None:
    part_id = f"about-{axis}"
    answers = {part_id: entries(turn(axis, phi))}
    assert full_marks(part(handed_in(catalogue["fundamental-rotations"], answers), part_id))
    back = part(
        handed_in(catalogue["fundamental-rotations"], {part_id: entries(turn(axis, -phi))}), part_id
    )
    assert back.verdict is Verdict.PARTIAL
    assert all_codes(back) == {"turn_sign"}


@pytest.mark.parametrize("part_id", COMPOSITES)
def test_the_composite_rotations_are_right(part_id: str, catalogue: Mapping[str, Exercise]) -> None:
    answers = {part_id: entries(COMPOSITES[part_id])}
    assert full_marks(part(handed_in(catalogue["composite-rotations"], answers), part_id))


@pytest.mark.parametrize(
    ("part_id", "matrix", "code", "said"),
    [
        ("fixed", Z * X * Y, "fixed_for_moving_axes", "Every turn"),
        ("mobile", Y * X * Z, "fixed_for_moving_axes", "Every turn"),
        ("mixed", Z * X * Y, "fixed_for_moving_axes", "Turn 3"),
        ("fixed", Y * turn("x", -theta) * Z, "turn_sign", "Turn 2"),
        ("fixed", Y * turn("z", theta) * Z, "turn_axis", "Turn 2"),
        ("mobile", turn("y", phi) * X * Y, "turn_axis", "Turn 1"),
        ("mobile", Z * X, "missing_turn", "Turn 3"),
    ],
)
def test_a_wrong_composition_is_named(
    part_id: str, matrix: Any, code: str, said: str, catalogue: Mapping[str, Exercise]
) -> None:
    answers = {part_id: entries(matrix)}
    report = part(handed_in(catalogue["composite-rotations"], answers), part_id)
    [message] = report.feedback
    assert (message.code, said in message.message) == (code, True)
    assert all_codes(report) == {code}


def test_a_slip_in_one_entry_is_named_there(catalogue: Mapping[str, Exercise]) -> None:
    matrix = entries(COMPOSITES["fixed"])
    matrix[2][0] = f"-({matrix[2][0]})"
    report = part(handed_in(catalogue["composite-rotations"], {"fixed": matrix}), "fixed")
    assert not_correct(report) == {("3", "1"): Verdict.INCORRECT}
    assert "sign" in all_codes(report)


# Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Example 3.
SPATIAL = [["c1 c23", "-c1 s23", "s1"], ["s1 c23", "-s1 s23", "-c1"], ["s23", "c23", "0"]]


def test_the_rotation_of_a_robot_is_right(make_exercise: Make) -> None:
    exercise = make_exercise(one_part("rotation", "", SPATIAL_RRR))
    assert full_marks(graded(exercise, SPATIAL))
    transposed = [list(column) for column in zip(*SPATIAL, strict=True)]
    assert all_codes(graded(exercise, transposed)) == {"transposed_rotation"}


def test_the_rotation_between_two_frames_is_right(make_exercise: Make) -> None:
    exercise = make_exercise(one_part("rotation", "from = 1\nto = 2", SPATIAL_RRR))
    assert full_marks(graded(exercise, [["c2", "-s2", 0], ["s2", "c2", 0], [0, 0, 1]]))
    back = make_exercise(one_part("rotation", 'from = "tool"\nto = "base"', SPATIAL_RRR))
    transposed = [list(column) for column in zip(*SPATIAL, strict=True)]
    assert full_marks(graded(back, transposed))


@pytest.mark.parametrize("answer", [[], "", [[1] * 3] * 4, {"rows": []}, 7])
def test_an_answer_of_another_shape_is_unreadable(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(one_part("rotation", "", SPATIAL_RRR)), answer)
    assert report.points == 0
    assert report.verdict in (Verdict.UNREADABLE, Verdict.MISSING)
