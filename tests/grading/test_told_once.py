"""A slip gets one message, and errors that it causes elsewhere get none."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Submission, grade
from dh_grader.grading.report import PartReport

STANFORD = """\
0, -90deg, 0, theta1
0, 90deg, d2, theta2
0, 0, {d}, {theta}
0, -90deg, 0, theta4
0, 90deg, 0, theta5
0, 0, d6, theta6"""
RIGHT = STANFORD.format(d="d3", theta="0")


def report(exercise: Exercise, part: str, answer: str, degrees: bool = False) -> PartReport:
    graded = grade(exercise, Submission({part: answer}, "degrees" if degrees else "radians"))
    return next(each for each in graded.parts if each.part == part)


def told(part: PartReport) -> list[str]:
    found = [*part.feedback, *(m for row in part.rows for m in row.feedback)]
    found += [m for row in part.rows for cell in row.cells for m in cell.feedback]
    return [m.code for m in found if m.code != "column_order"]


def test_a_unit_slip_leaves_no_remark_on_frames(catalogue: Mapping[str, Exercise]) -> None:
    in_radians = RIGHT.replace("90deg", "1.5708")
    part = report(catalogue["stanford-arm"], "table", in_radians, degrees=True)
    assert told(part) == ["radians_as_degrees"]


def test_an_extra_row_gets_no_other_message(catalogue: Mapping[str, Exercise]) -> None:
    first, *others = RIGHT.split("\n")
    rows = "\n".join([first, "1, 45deg, 1, 1", *others])
    assert told(report(catalogue["stanford-arm"], "table", rows)) == [
        "rows_matched",
        "row_too_many",
    ]


@pytest.mark.parametrize(
    ("variable", "code"),
    [("theta3", "joint_variable_absent"), ("d3", "joint_variable_column")],
)
def test_a_variable_in_the_wrong_column_is_one_slip(
    variable: str, code: str, catalogue: Mapping[str, Exercise]
) -> None:
    rows = STANFORD.format(d="0", theta=variable)
    assert told(report(catalogue["stanford-arm"], "table", rows)) == [code]


def test_a_message_on_the_home_pose_does_not_mention_joint_starts(
    catalogue: Mapping[str, Exercise],
) -> None:
    pose = "[1, 0, 0, 1.037165; 0, 1, 0, 0; 0, 0, 1, 0.19135; 0, 0, 0, 1]"
    [message] = report(catalogue["baxter-left-arm"], "home", pose).feedback
    assert "joint 2 starts" not in message.message
    assert "θ, the angle about the axis of joint 2, is not right" in message.message
