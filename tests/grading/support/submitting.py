"""Submit answers, and search the report."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

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

from tests.grading.support.robots import COLUMNS, AngleUnit


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
