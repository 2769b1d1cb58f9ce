"""Put the rows that an exercise gives into a submitted table."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from service.catalogue import ReferenceTable
from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.feedback import Finding
from service.grading.judging.table import column_scales
from service.grading.misconception import register
from service.grading.numerics.comparison import nearly_equal
from service.grading.part import Grading
from service.grading.reading.entry import Entry
from service.grading.reading.tables.table import IS_ANGLE, StudentRow, StudentTable
from service.grading.report import Severity, Verdict
from service.kinematics.chain import Table
from service.translations import say

_CHANGED = register(
    of=StudentTable,
    code="given_row_changed",
    rule="rows",
    means="a given row says something else in the answer; it was graded as it is given, and costs "
    "nothing (a warning)",
    example=(
        "planar-rrr-faded",
        "table",
        "0, 0, 0, q1 ↵ l2, 0, 0, q2 ↵ l2, 0, 0, q3 ↵ l3, 0, 0, 0",
    ),
    unlike={"3/a": "l1"},
)


def with_given_rows(part: DhTableSpec, table: StudentTable, grading: Grading) -> StudentTable:
    """Return the table with the rows that the exercise gives."""
    # A table with too many rows is unchanged.
    if not part.given or not table.rows:
        return table
    robot = grading.exercise.robot
    reference = robot.tables[robot.convention]
    given = {i - 1: _given_row(reference, i - 1, grading) for i in part.given}
    handed_in = _in_places(table.rows, given, len(reference.rows), grading)
    if handed_in is None:
        return table
    filled = tuple(row for i, own in enumerate(handed_in) if (row := given.get(i, own)) is not None)
    findings = tuple(
        _changed(reference.labels[i])
        for i, right in given.items()
        if (row := handed_in[i]) is not None and _is_changed(row, right, grading)
    )
    reread = table.reread
    return replace(
        table,
        rows=filled,
        values=np.array([row.values for row in filled]),
        findings=(*table.findings, *findings),
        reread=reread and (lambda order: with_given_rows(part, reread(order), grading)),
    )


def _in_places(
    rows: tuple[StudentRow, ...],
    given: Mapping[int, StudentRow],
    count: int,
    grading: Grading,
) -> list[StudentRow | None] | None:
    # None in the list where the student submitted no row; None instead of a list if there are too
    # many rows.
    if len(rows) == count:
        return list(rows)
    own = [
        row
        for row in rows
        if not any(_is_taken_over(row, each, grading) for each in given.values())
    ]
    if len(own) > count - len(given):
        return None
    others = iter(own)
    return [None if i in given else next(others, None) for i in range(count)]


def _given_row(reference: ReferenceTable, i: int, grading: Grading) -> StudentRow:
    entries = tuple(map(Entry, reference.rows[i]))
    samples = grading.samples
    values: Table = np.array(
        [
            np.broadcast_to(formula.evaluate(samples.values), samples.count)
            for formula in reference.rows[i]
        ]
    )
    return StudentRow(entries, values)


def _is_taken_over(row: StudentRow, right: StudentRow, grading: Grading) -> bool:
    is_full = all(entry.verdict is not Verdict.MISSING for entry in row.entries)
    return is_full and not _is_changed(row, right, grading)


def _is_changed(row: StudentRow, right: StudentRow, grading: Grading) -> bool:
    scales = column_scales(grading)
    equal = nearly_equal(row.values, right.values, scales, IS_ANGLE[:, None])
    cells = zip(row.entries, right.entries, equal.tolist(), strict=True)
    return not all(
        is_equal or own.verdict is Verdict.MISSING or _text(own) == _text(given)
        for own, given, is_equal in cells
    )


def _text(entry: Entry) -> str | None:
    return None if entry.expression is None else entry.expression.source


def _changed(label: str) -> Finding:
    return _CHANGED.finding(
        say(
            "Row {row} is given, and your answer has something else there. It was graded as it is "
            "given: take it over as it stands, and look at the other rows.",
            row=label,
        ),
        severity=Severity.WARNING,
    )
