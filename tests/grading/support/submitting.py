"""Write exercises, hand answers in, and read their points."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import (
    CellReport,
    FeedbackLevel,
    PartReport,
    Report,
    RowReport,
    Submission,
    Verdict,
    grade,
)
from dh_grader.grading.report import messages_of

from tests.grading.support.robots import COLUMNS, AngleUnit, Robot

# --- Submit answers, and search the report


def table(rows: Iterable[Sequence[object]]) -> dict[str, Any]:
    return {"rows": [dict(zip(COLUMNS, row, strict=True)) for row in rows]}


def handed_in(
    exercise: Exercise,
    answers: Mapping[str, object],
    angle_unit: AngleUnit = "radians",
    feedback: FeedbackLevel = FeedbackLevel.FULL,
) -> Report:
    return grade(exercise, Submission(answers, angle_unit=angle_unit, feedback=feedback))


def part(report: Report, part_id: str) -> PartReport:
    [found] = [part for part in report.parts if part.part == part_id]
    return found


def graded_table(
    exercise: Exercise, rows: Iterable[Sequence[object]], angle_unit: AngleUnit = "radians"
) -> PartReport:
    return part(handed_in(exercise, {"table": table(rows)}, angle_unit), "table")


def graded_pose(
    exercise: Exercise, matrix: object, angle_unit: AngleUnit = "radians"
) -> PartReport:
    return part(handed_in(exercise, {"pose": matrix}, angle_unit), "pose")


def row(report: PartReport, label: str) -> RowReport:
    [found] = [row for row in report.rows if row.label == label]
    return found


def cell(report: PartReport, row_label: str, cell_label: str) -> CellReport:
    [found] = [cell for cell in row(report, row_label).cells if cell.label == cell_label]
    return found


def codes(cell: CellReport) -> list[str]:
    return [message.code for message in cell.feedback]


def codes_at(report: PartReport, row_label: str, cell_label: str) -> list[str]:
    """Return the codes of all messages about a cell."""
    return [
        message.code
        for message, places, _ in messages_of(report)
        if (row_label, cell_label) in [(place.row, place.cell) for place in places]
    ]


def not_correct(report: PartReport) -> dict[tuple[str, str], Verdict]:
    return {
        (row.label, cell.label): cell.verdict
        for row in report.rows
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    }


def full_marks(report: PartReport) -> bool:
    return (
        report.verdict is Verdict.CORRECT
        and report.points == report.max_points
        and not not_correct(report)
        and all(row.points == row.max_points for row in report.rows)
    )


def as_data(report: Report) -> dict[str, Any]:
    return asdict(report)


# --- Write exercise files with a single part for tests

Make = Callable[[str], Exercise]

HEAD = """
title = "Made for a test"
source = "none"
statement = "Nothing to see."
"""

# Spatial RRR: Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Example 3.
SPATIAL_RRR = """
[robot]
structure = "RRR"
convention = "standard"
joints = ["theta1", "theta2", "theta3"]
table = [
    ["R", "90deg", "0", "theta1"], ["L1", "0", "0", "theta2"], ["L2", "0", "0", "theta3"],
]
[symbols]
R = { kind = "length", description = "radius" }
L1 = { kind = "length", description = "first link" }
L2 = { kind = "length", description = "second link" }
"""

ANGLES = """
[symbols]
phi = { kind = "angle", description = "an angle" }
psi = { kind = "angle", description = "an angle" }
l = { kind = "length", description = "a length" }
k = { kind = "number", description = "a number" }
"""


def one_part(kind: str, fields: str, setting: str = ANGLES) -> str:
    """Return the text of an exercise with one part of this kind."""
    part_text = f'[[parts]]\nid = "it"\nkind = "{kind}"\ntitle = "It"\npoints = 6\n{fields}\n'
    return HEAD + setting + part_text


def graded(exercise: Exercise, answer: object, angle_unit: AngleUnit = "radians") -> PartReport:
    """Grade an answer to the exercise's only part, and return the report on the part."""
    return part(handed_in(exercise, {"it": answer}, angle_unit), "it")


def all_codes(report: PartReport) -> set[str]:
    messages = [*report.feedback]
    for row in report.rows:
        messages += row.feedback
        for cell in row.cells:
            messages += cell.feedback
    return {message.code for message in messages}


# --- Compute the expected points of a table from its text


def worth_of_rows(robot: Robot) -> list[float]:
    return [0.2 + sum(is_known(robot, i, j) for j in range(4)) for i in range(len(robot.rows))]


def is_known(robot: Robot, row: int, column: int) -> bool:
    cell = robot.rows[row][column]
    return cell != "0" and not cell.endswith("*")


# Computed by hand: the points of a content cell, of each row besides its cells, and of the unread
# cells of a row that are not content cells. A cell is worth the part's points, divided by the sum
# of `worth_of_rows`, as a whole number of quarters; the rows share what is left.
UNIT = {"stanford-arm": 1.75, "scara": 1.75, "rrrp": 1.25, "planar-rrr": 2.0}
BESIDES = {
    "stanford-arm": [0.25] * 6,
    "scara": [0.25] * 4,
    "rrrp": [0.5, 0.5, 0.5, 0.25],
    "planar-rrr": [0.5] * 4,
}
UNREAD = {"stanford-arm": 0.25, "scara": 0.25, "rrrp": 0.25, "planar-rrr": 0.5}


def points(robot: Robot, wrong: Iterable[int], unread: Iterable[int] = ()) -> list[float]:
    """Return the expected points of each row of a table."""
    # `wrong` has the row number of each wrong cell. `unread` has the numbers of rows in which a
    # cell that is 0 or only the joint variable was not read.
    wrong, unread, name = list(wrong), set(unread), robot.exercise
    worth = [
        BESIDES[name][i] + UNIT[name] * sum(is_known(robot, i, j) for j in range(4))
        for i in range(len(robot.rows))
    ]
    return [
        max(0.0, each - UNIT[name] * wrong.count(i) - UNREAD[name] * (i in unread))
        for i, each in enumerate(worth)
    ]


def about(values: Sequence[float]) -> object:
    return pytest.approx(list(values), abs=2e-6)
