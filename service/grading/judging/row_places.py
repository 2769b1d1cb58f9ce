"""Messages on missing rows, extra rows, and rows that are graded under a new row number."""

from functools import reduce
from typing import Final

from service.grading.feedback import Finding
from service.grading.judging.table import JudgedRow, Judgement
from service.grading.misconception import register
from service.grading.part import Grading
from service.grading.reading.tables.table import StudentTable
from service.grading.report import Severity
from service.kinematics.dh import Convention
from service.translations import Sentence, say, template

_END_EFFECTOR: Final = template("row {row} with the end effector")
_FIXED_BEFORE: Final = template("row {row} with the fixed row {label} before the last joint")
_FIXED_BEHIND: Final = template("row {row} with the fixed row {label} behind the last joint")
_MATCHED = register(
    of=StudentTable,
    code="rows_matched",
    rule="rows",
    means="rows that are graded under another number than they have in the answer, because some "
    "are missing or too many (an info)",
    example=("planar-rr", "table", "a2, 0, 0, q2"),
    unlike={"1/d": "1"},
)

EXTRA_ROW = register(
    of=StudentTable,
    code="extra_row",
    rule="rows",
    means="a row that belongs to no joint of this robot; it costs what a wrong cell costs",
    example=(
        "planar-rrr-drawn",
        "table",
        (
            "a, alpha, d, theta ↵ 0, 0, 0, q1 ↵ l1, 0, 0, q2 ↵ l2, 0, 0, q3 ↵ l3, 0, 0, 0 ↵ l3, 0, "
            "0, 0"
        ),
    ),
    unlike={"1/a": "l1"},
)
_MISSING_ROW = register(
    of=StudentTable,
    code="missing_row",
    rule="rows",
    means="a joint has no row",
    example=("planar-rr", "table", "a1, 0, 0, q1"),
    unlike={"1/d": "1"},
)
_MISSING_TOOL_ROW = register(
    of=StudentTable,
    code="missing_tool_row",
    rule="rows",
    means="the last row, from the last joint's frame to the end effector, is not there",
    example=("planar-rrr", "table", "0, 0, 0, q1 ↵ l1, 0, 0, q2 ↵ l2, 0, 0, q3"),
    unlike="0, 0, 0, q1 ↵ l2, 0, 0, q3 ↵ l3, 0, 0, 0",
)
_ROW_TOO_MANY = register(
    of=StudentTable,
    code="row_too_many",
    rule="rows",
    means="a fixed row that the arm does not need, in a wrong table: it earns nothing (a warning)",
    example=("planar-rr", "table", "a1, 0, 0, q1 ↵ 5, 0, 0, 0 ↵ a2, 0, 0, q2 ↵ a1, 0, 0, 0"),
    unlike={"2/a": "a1"},
)


def row_places(
    table: StudentTable, judgement: Judgement, convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    """Return a message on the rows that are graded under a new row number."""
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
        _compared(place + 1, judged)
        for judged in judgement.rows
        if judged.row is not None
        for place in [places[id(judged.row.entries)]]
        if judged.label != (labels[place] if place < len(labels) else "e")
    ]
    if not moved:
        return ()
    rows = reduce(lambda one, other: say("{one}, {other}", one=one, other=other), moved)
    message = say("Your rows were compared in this way: {rows}.", rows=rows)
    return (_MATCHED.finding(message, severity=Severity.INFO),)


def _compared(row: int, judged: JudgedRow) -> Sentence:
    if judged.joint is not None:
        return say("row {row} with joint {joint}", row=row, joint=judged.joint.index)
    if judged.label == "e":
        return say(_END_EFFECTOR, row=row)
    fixed = _FIXED_BEFORE if judged.label.startswith("0") else _FIXED_BEHIND
    return say(fixed, row=row, label=judged.label)


def missing_row(judged: JudgedRow) -> Finding:
    """Return the finding on a missing row."""
    if judged.joint is not None:
        return _MISSING_ROW.finding(
            say("There is no row for joint {joint}.", joint=judged.joint.index)
        )
    return _MISSING_TOOL_ROW.finding(
        say("The fixed row that leads from the last joint's frame to the end effector is missing."),
    )


def row_too_many(i: int) -> Finding:
    """Return the finding on a fixed row that the arm does not need."""
    return _ROW_TOO_MANY.finding(
        say(
            "Row {row} of your table belongs to no joint and not to the end effector: check "
            "whether you need it.",
            row=i + 1,
        ),
        severity=Severity.WARNING,
    )


def extra_row(i: int) -> Finding:
    """Return the finding on a row that belongs neither to a joint nor to the end effector."""
    return EXTRA_ROW.finding(
        say(
            "Row {row} of your table belongs to no joint and not to the end effector: leave it "
            "out.",
            row=i + 1,
        ),
    )
