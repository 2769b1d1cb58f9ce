"""One slip in a table costs the points of one cell."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Severity, Verdict

from tests.grading.support.robots import COLUMNS, EXACT, ROBOTS, Robot
from tests.grading.support.slips import Slip, slips
from tests.grading.support.submitting import cell, graded_table, not_correct, row
from tests.grading.support.worth import about, is_known, points

CELLS = [
    (robot, i, j) for robot in ROBOTS for i in range(len(robot.rows)) for j in range(len(COLUMNS))
]


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("robot", "i", "j"),
    CELLS,
    ids=[f"{robot.exercise} {robot.labels[i]}.{COLUMNS[j]}" for robot, i, j in CELLS],
)
def test_a_slip_costs_only_its_own_cell(
    robot: Robot, i: int, j: int, given_frames: Mapping[str, Exercise]
) -> None:
    for slip in slips(robot, i, j):
        check(slip, given_frames[robot.exercise])


def check(slip: Slip, exercise: Exercise) -> None:
    rows = [list(cells) for cells in EXACT.rows(slip.robot)]
    rows[slip.row][slip.column] = slip.text
    report = graded_table(exercise, rows, angle_unit=slip.angle_unit)

    label, column = slip.robot.labels[slip.row], COLUMNS[slip.column]
    assert not_correct(report) == {(label, column): slip.verdict}, slip
    # An empty cell costs as much as a wrong one, an unreadable cell only its worth.
    wrong = slip.verdict is not Verdict.UNREADABLE
    wrong = wrong or is_known(slip.robot, slip.row, slip.column)
    expected = points(slip.robot, [slip.row] * wrong, [slip.row] * (not wrong))
    assert report.verdict is Verdict.PARTIAL, slip
    assert [row.points for row in report.rows] == about(expected), slip
    assert report.points == pytest.approx(sum(expected), abs=1e-5), slip
    # A row that earns nothing is not partly right.
    verdict = Verdict.PARTIAL if expected[slip.row] else slip.verdict
    assert row(report, label).verdict is verdict, slip

    [feedback] = cell(report, label, column).feedback
    assert (feedback.code, feedback.severity) == (slip.code, Severity.ERROR), slip
    assert feedback.message.strip().endswith((".", "?")), slip


def test_each_table_is_tried_with_many_slips(figure: Callable[[str], None]) -> None:
    for robot in ROBOTS:
        cells = [(i, j) for known, i, j in CELLS if known is robot]
        count = sum(len(list(slips(robot, i, j))) for i, j in cells)
        figure(f"{robot.exercise}: {count} single-cell slips, each graded alone")
        assert count > 8 * len(cells)
