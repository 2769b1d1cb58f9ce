"""Grade matrices of any size."""

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.exercise_texts import Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part

MATRIX = one_part("matrix", 'expected = [["1", "l", "phi"], ["k^2", "sin(phi)", "0"]]')


def test_a_matrix_of_any_size_is_graded(make_exercise: Make) -> None:
    exercise = make_exercise(MATRIX)
    assert full_marks(graded(exercise, [[1, "l", "phi"], ["k*k", "sin phi", 0]]))
    assert full_marks(graded(exercise, "[1 l phi; k^2 sin(phi) 0]"))
    report = graded(exercise, [[1, "l", "-phi"], ["k", "sin phi", 0]])
    assert set(not_correct(report)) == {("1", "3"), ("2", "1")}
    # Five entries are not 0. They are worth 1.25 points each, the last one 1. Two are wrong.
    assert report.points == 6 - 2 * 1.25


@pytest.mark.parametrize("answer", [[[1, 2, 3]] * 3, [], 4, [["1"]] * 2])
def test_a_matrix_of_the_wrong_size_is_unreadable(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(MATRIX), answer)
    assert (report.verdict, report.points) == (Verdict.UNREADABLE, 0)


def test_the_chain_of_rigid_motions(catalogue: Mapping[str, Exercise]) -> None:
    # Source: Robot kinematics lecture notes, equations 2.13 to 2.15, multiplied out by hand.
    c, s, ct, st = "cos(phi)", "sin(phi)", "cos(theta)", "sin(theta)"
    rotation: list[list[Any]] = [
        [c, f"-{s}*{ct}", f"{s}*{st}"],
        [s, f"{c}*{ct}", f"-{c}*{st}"],
        [0, st, ct],
    ]
    origin = [f"l1 - l2*{s}", f"l2*{c}", "h"]
    answers: dict[str, Any] = {
        "rotation": rotation,
        "origin": origin,
        "transform": [[*row, d] for row, d in zip(rotation, origin, strict=True)] + [[0, 0, 0, 1]],
        "point": [f"{d} + l3*({row[2]})" for row, d in zip(rotation, origin, strict=True)],
        "parallel-axes": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    }
    report = handed_in(catalogue["rigid-motion-chain"], answers)
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)
    literal = {"parallel-axes": [[1, 0, 0], [0, 0, 1], [0, 1, 0]]}
    misread = part(handed_in(catalogue["rigid-motion-chain"], literal), "parallel-axes")
    assert "left_handed_rotation" in all_codes(misread)
