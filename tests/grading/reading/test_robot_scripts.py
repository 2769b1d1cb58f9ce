"""Grade a script for a robotics toolbox as the table of its links."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import AngleUnit
from dh_grader.grading import PartReport, Severity, Verdict
from dh_grader.grading.reading import preview_pasted

from tests.grading.reading.robot_scripts import (
    by_column,
    by_name,
    in_matlab,
    in_python,
    of_bodies,
)
from tests.grading.support.robots import RRRP, SCARA, STANFORD, Robot
from tests.grading.support.submitting import full_marks, handed_in, part, table

ROBOTS = (RRRP, SCARA, STANFORD)


def graded(exercise: Exercise, answer: object, angle_unit: AngleUnit = "radians") -> PartReport:
    return part(handed_in(exercise, {"table": answer}, angle_unit), "table")


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
@pytest.mark.parametrize("write", [in_matlab, by_name, in_python, of_bodies, by_column])
def test_a_script_gets_full_marks_and_fills_the_same_rows(
    write: Callable[[Robot], str], robot: Robot, catalogue: Mapping[str, Exercise]
) -> None:
    exercise, text = catalogue[robot.exercise], write(robot)
    report = graded(exercise, text)
    assert full_marks(report), report
    assert {message.severity for message in report.feedback} <= {Severity.INFO}
    preview = preview_pasted(text, exercise, "table")
    assert preview.ok
    assert full_marks(graded(exercise, table([cell.entry for cell in row] for row in preview.rows)))


def test_a_script_is_in_radians_regardless_of_the_submission(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue[SCARA.exercise]
    text = in_matlab(SCARA).replace("a2 pi", "a2 3.141592653589793")
    text = text.replace("0]);", "0 6.283185307179586]);", 1)
    assert full_marks(graded(exercise, text, "degrees"))
    rows = preview_pasted(text, exercise, "table", "degrees").rows
    assert (rows[0][3].entry, rows[1][1].entry) == (
        "theta1 + 6.283185307179586rad",
        "3.141592653589793rad",
    )
    entries = table([cell.entry for cell in row] for row in rows)
    assert full_marks(graded(exercise, entries, "degrees"))


def test_a_script_in_the_other_convention_gets_a_message(catalogue: Mapping[str, Exercise]) -> None:
    text = in_matlab(RRRP).replace("]);", "], 'modified');")
    report = graded(catalogue[RRRP.exercise], text)
    assert full_marks(report)
    assert "convention_not_asked_for" in [message.code for message in report.feedback]


def test_a_slip_is_found_in_its_link(catalogue: Mapping[str, Exercise]) -> None:
    text = in_matlab(SCARA).replace("a2 pi", "a2 0")
    report = graded(catalogue[SCARA.exercise], text)
    wrong = [
        (row.label, cell.label)
        for row in report.rows
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    ]
    assert wrong == [("2", "alpha")]


def test_a_script_is_not_a_matrix(catalogue: Mapping[str, Exercise]) -> None:
    report = part(handed_in(catalogue[RRRP.exercise], {"pose": in_matlab(RRRP)}), "pose")
    assert report.verdict is Verdict.UNREADABLE
