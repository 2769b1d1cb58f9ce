"""The message on rows that are graded under another number than the student's."""

from typing import Final

from service.grading.feedback import Finding
from service.grading.judging.table import JudgedRow, Judgement
from service.grading.part import Grading
from service.grading.reading.tables.table import StudentTable
from service.grading.report import Severity
from service.kinematics.dh import Convention

# Fixed rows by their labels.
_FIXED: Final = {"0": "the fixed row before the first joint", "e": "the end effector"}


def row_places(
    table: StudentTable, judgement: Judgement, convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    """Return the finding on rows that are graded under another number than in the answer."""
    robot = grading.exercise.robot
    reference = robot.tables.get(convention)
    labels = [str(joint.index) for joint in robot.joints]
    if reference is not None:
        labels = list(reference.labels)
    handed_in = [row.entries for row in table.rows]
    graded = [judged.row and judged.row.entries for judged in judgement.rows]
    if graded == handed_in and [judged.label for judged in judgement.rows] == labels:
        return ()
    # Compare entries: rows with rounded angles made exact are new objects with the same entries.
    places = {id(row.entries): i for i, row in enumerate(table.rows)}
    moved = [
        f"row {place + 1} with {_of(judged)}"
        for judged in judgement.rows
        if judged.row is not None
        for place in [places[id(judged.row.entries)]]
        if judged.label != (labels[place] if place < len(labels) else "e")
    ]
    if not moved:
        return ()
    message = f"Your rows were compared in this way: {', '.join(moved)}."
    return (Finding("rows_matched", message, severity=Severity.INFO),)


def _of(judged: JudgedRow) -> str:
    if judged.joint is not None:
        return f"joint {judged.joint.index}"
    return _FIXED.get(judged.label, f"the fixed row {judged.label} behind the last joint")
