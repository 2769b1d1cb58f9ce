"""Grade lists of lengths, angles and numbers."""

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.submitting import cell, full_marks, handed_in, not_correct, part

TASK = ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]


@pytest.mark.parametrize("angle", ["theta1 + theta2", "θ1 + θ2 - 2π", "atan2(s12, c12)"])
def test_an_angle_of_a_vector_counts_modulo_whole_turns(
    angle: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = handed_in(catalogue["planar-rr"], {"task-space": [*TASK, angle]})
    assert full_marks(part(report, "task-space"))


@pytest.mark.parametrize(
    ("answer", "row", "code"),
    [
        ([*TASK, "-theta1 - theta2"], "3", "sign"),
        ([*TASK, "theta1 + theta2 + pi"], "3", "half_turn"),
        ([*TASK, "theta1 + theta2 + pi/2"], "3", "quarter_turn"),
        ([*TASK, "atan(s12/c12)"], "3", "lost_quadrant"),
        ([*TASK, "pi/2 - theta1 - theta2"], "3", "swapped_atan2"),
        ([*TASK, "theta2"], "3", "joint_variable_missing"),
        (["a1 c1 + a2 c2", TASK[1], "theta1 + theta2"], "1", "relative_angle"),
    ],
)
def test_a_slip_in_a_vector_is_named(
    answer: list[str], row: str, code: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = part(handed_in(catalogue["planar-rr"], {"task-space": answer}), "task-space")
    assert not_correct(report) == {(row, "1"): Verdict.INCORRECT}
    assert report.points == 2
    assert [message.code for message in cell(report, row, "1").feedback] == [code]


def test_a_length_is_not_an_angle(catalogue: Mapping[str, Exercise]) -> None:
    answer = [f"{TASK[0]} + 2*pi", TASK[1], "theta1 + theta2"]
    report = part(handed_in(catalogue["planar-rr"], {"task-space": answer}), "task-space")
    assert not_correct(report) == {("1", "1"): Verdict.INCORRECT}


def test_the_twists_of_the_lecture_are_right(catalogue: Mapping[str, Exercise]) -> None:
    # Source: Screw Theory, Example: Simple Twist, with S_ω = (0, 0, 1) and S_v = (0, −2, 0).
    answers: dict[str, Any] = {
        "zero-pitch": [[0, 0, 1, 0, -2, 0]],
        "twist": [0, 0, "w", 0, "-2 w", 0],
        "pitch": [0, 0, 1, 0, -2, "h"],
        "infinite-pitch": [[0, 0, 0, 1, 0, 0]],
        "exponential": [
            ["cos theta", "-sin theta", 0, "2 - 2 cos theta"],
            ["sin theta", "cos theta", 0, "-2 sin theta"],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        ],
    }
    report = handed_in(catalogue["simple-twist"], answers)
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)
