"""Make report rows from entries and the results of their comparison."""

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from service.grading.feedback import ROUNDED, Finding
from service.grading.numerics.comparison import Match
from service.grading.part import Grading
from service.grading.reading.entry import Entry
from service.grading.reading.lists.value_list import StudentValues
from service.grading.report import CellReport, Place, ReadEntry, RowReport, Verdict, row_report

_EXACT = int(Match.EXACT)

# Findings on single entries, by row and column.
Slips = Mapping[tuple[int, int], Finding]


def entry_rows(
    entries: Sequence[Sequence[Entry]],
    found: NDArray[np.int_],
    slips: Slips,
    grading: Grading,
    *,
    labels: Sequence[str] | None = None,
    remarks: Mapping[int, Finding] | None = None,
) -> tuple[RowReport, ...]:
    """Return report rows of entries; ``found`` has the comparison result of each entry.

    ``remarks`` are findings on whole rows.
    """
    names = labels or [str(i + 1) for i in range(len(entries))]
    columns = tuple([str(j + 1) for j in range(found.shape[1])])

    def report(i: int, row: Sequence[Entry], of_row: list[int]) -> RowReport:
        remark = remarks.get(i) if remarks else None
        if remark is None and is_right_throughout(row, of_row, grading):
            return right_row(names[i], columns)
        cells = [
            cell_report(entry, columns[j], match, slips.get((i, j)), grading)
            for j, (entry, match) in enumerate(zip(row, of_row, strict=True))
        ]
        return row_report(names[i], tuple(cells), grading.messages((remark,)) if remark else ())

    return tuple(
        report(i, row, of_row)
        for i, (row, of_row) in enumerate(zip(entries, found.tolist(), strict=True))
    )


def value_rows(
    student: StudentValues, found: NDArray[np.int_], slips: Slips, grading: Grading
) -> tuple[RowReport, ...]:
    """Return a report row for each of n values; ``found`` ``(n,)`` has the comparison results."""
    column = [[entry] for entry in student.entries]
    return entry_rows(column, found[:, None], slips, grading)


def value_places(marked: NDArray[np.bool_]) -> tuple[Place, ...]:
    """Return the places of the values in a list for which ``marked`` is True."""
    return tuple(Place(str(i + 1), "1") for i in np.flatnonzero(marked).tolist())


@lru_cache(maxsize=64)
def _right(column: str) -> CellReport:
    return CellReport(column, Verdict.CORRECT)


@lru_cache(maxsize=256)
def right_row(label: str, columns: tuple[str, ...]) -> RowReport:
    """Return the report on a row whose entries are all right; the report has no messages."""
    return row_report(label, tuple(map(_right, columns)))


def is_right_throughout(entries: Sequence[Entry], found: list[int], grading: Grading) -> bool:
    """True if a row is correct and has no messages; ``found`` has the comparison results."""
    if grading.echo or found.count(_EXACT) < len(found):
        return False
    return all(entry.expression is not None and not entry.findings for entry in entries)


def cell_report(
    entry: Entry, column: str, match: int, slip: Finding | None, grading: Grading
) -> CellReport:
    """Return the report on an entry; ``column`` is the label of the cell.

    ``match`` is the result of comparing the entry.
    """
    # If a wrong entry has no ``slip``, a message on the part explains it.
    verdict, findings = entry.verdict, entry.findings
    if match == _EXACT and not findings and entry.expression is not None and not grading.echo:
        return _right(column)
    if match == Match.ROUNDED:
        findings = (*findings, ROUNDED)
    elif entry.expression is not None and match < Match.ROUNDED:
        verdict = Verdict.INCORRECT
        if slip is not None:
            findings = (*findings, slip)
    return CellReport(column, verdict, grading.messages(findings), _read(entry, grading))


def _read(entry: Entry, grading: Grading) -> ReadEntry | None:
    if not grading.echo or entry.expression is None:
        return None
    return ReadEntry(entry.expression.text(), entry.expression.latex())
