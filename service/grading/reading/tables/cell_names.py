"""Find the column and row that a cell's name means, as in theta_1 = q1."""

from collections.abc import Callable, Sequence
from typing import Final

from service.expressions import LeftSide, Vocabulary
from service.expressions.vocabulary.symbols import normal_form
from service.grading.feedback import Finding
from service.grading.reading.entry import Entry, unreadable
from service.grading.reading.tables.column_headers import SHOWN, named_parameter
from service.grading.reading.written_names import (
    Arrangement,
    Places,
    arranged,
    misnamed_value,
    name_of,
    with_order_note,
)
from service.kinematics.chain import COLUMNS
from service.translations import say

_LABELS: Final = tuple(SHOWN[column] for column in COLUMNS)
# The parameters that the modified convention numbers one less than their row.
_SHIFTED: Final = frozenset({"a", "alpha"})


def arranged_row(cells: Sequence[object], vocabulary: Vocabulary) -> Arrangement | None:
    """Arrange the four cells of a row by their names; None if they are in order."""
    return arranged(cells, _LABELS, _columns_of, vocabulary)


def _columns_of(names: Sequence[LeftSide | None], _: Vocabulary) -> list[Places]:
    found = [named_parameter(name.name) if name else None for name in names]
    return [(COLUMNS.index(each.column),) if each else None for each in found]


def first_number(rows: Sequence[Sequence[object]], vocabulary: Vocabulary) -> int | None:
    """Return the number of the first row: 0 if its θ or d has the index 0, else 1."""
    # None for a single row, which may belong to any joint.
    if len(rows) < 2:
        return None
    names = [name_of(cell, vocabulary) for cell in rows[0]]
    named = [named_parameter(name.name) for name in names if name]
    counts_from_zero = any(each and each.row == 0 and each.column not in _SHIFTED for each in named)
    return 0 if counts_from_zero else 1


def row_entries(
    cells: Sequence[object],
    found: Arrangement | None,
    number: int | None,
    read: Callable[[int], Entry],
    placed: Callable[[int, Entry], Entry],
    vocabulary: Vocabulary,
) -> tuple[Entry, ...]:
    """Return the entries of a row whose ``cells`` were arranged by their names."""
    # ``found`` is the arrangement. ``read`` returns the entry of a column. ``placed`` moves the
    # spans of an entry from its cell to the whole text.
    entries: list[Entry] = []
    for column, cell in enumerate(cells):
        wrong = found.misnamed.get(column) if found else None
        entry = unreadable(wrong) if wrong else read(column)
        if wrong is None and number is not None and entry.findings:
            wrong = _names_another_row(cell, COLUMNS[column], entry, number, vocabulary)
        entries.append(placed(column, unreadable(wrong)) if wrong else entry)
    if found is None or not found.by_name:
        return tuple(entries)
    return with_order_note(entries, say("The cells of a row were ordered by their names."))


def _names_another_row(
    cell: object, column: str, entry: Entry, number: int, vocabulary: Vocabulary
) -> Finding | None:
    # Such as θ2 = … in row 1. None for a cell such as θ2 = θ2, which contains the variable that it
    # is named after.
    name = name_of(cell, vocabulary)
    named = named_parameter(name.name) if name else None
    if name is None or named is None or named.row is None or entry.expression is None:
        return None
    if named.row == number or (named.row == number - 1 and column in _SHIFTED):
        return None
    symbol = vocabulary.by_name.get(normal_form(name.name))
    if symbol is not None and symbol.name in entry.expression.symbols:
        return None
    return misnamed_value(name, say("{parameter} (row {row})", parameter=SHOWN[column], row=number))
