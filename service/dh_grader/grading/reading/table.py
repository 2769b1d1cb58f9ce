"""Read a submitted DH table, JSON or pasted text, as rows and their numbers.

This file knows how many rows a table may have and which names of conventions count.
``table_cells.py`` knows the shapes of JSON and the names of cells, ``pasted_table.py`` the texts.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

from dh_grader.expressions import Expression, Vocabulary
from dh_grader.expressions import read as read_expression
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import Entry, Reader, entry_values, from_grid_error
from dh_grader.grading.reading.headers import QUANTITIES
from dh_grader.grading.reading.pasted_table import (
    PastedTable,
    entries_of,
    read_pasted_table,
    table_of,
)
from dh_grader.grading.reading.table_cells import (
    canonical_table,
    first_number,
    has_unnamed_columns,
    memoized_row,
    read_row,
)
from dh_grader.grading.report import (
    MAX_SYMBOLS_AGAIN,
    Finding,
    Severity,
    UnreadableAnswerError,
    Verdict,
    WorkBudget,
    reading_error,
)
from dh_grader.kinematics import COLUMNS, Convention, Table
from dh_grader.pasting import GridError
from dh_grader.translations import say

# --- A table as read, and what others do with its rows


IS_ANGLE = np.array([QUANTITIES[column] == "angle" for column in COLUMNS])
MAX_ROWS = 12


@dataclass(frozen=True, slots=True)
class StudentRow:
    """One row as read: an entry for each of a, α, d, θ, and their numbers ``(4, SAMPLES)``.

    A number is NaN if its cell could not be read. If rounded angles were made exact in ``values``,
    ``as_written`` has the numbers as written.
    """

    entries: tuple[Entry, ...]
    values: Table
    as_written: Table | None = None

    @property
    def is_exact(self) -> bool:
        """True if the numbers are those that the student wrote."""
        return self.as_written is None

    @property
    def handed_in(self) -> Table:
        """The numbers that the student wrote."""
        return self.values if self.as_written is None else self.as_written

    @property
    def expressions(self) -> list[Expression | None]:
        """The expressions of the cells; None for a cell that could not be read."""
        return [entry.expression for entry in self.entries]

    @property
    def is_given_up(self) -> bool:
        """True if some cell was replaced by a number that is certainly wrong."""
        return any(entry is GIVEN_UP for entry in self.entries)

    @property
    def is_missing(self) -> bool:
        """True if all cells are empty."""
        return all(entry.verdict is Verdict.MISSING for entry in self.entries)

    @property
    def has_decimal(self) -> bool:
        """True if any cell contains a decimal."""
        for entry in self.entries:
            if entry.expression is not None and entry.expression.has_decimal:
                return True
        return False

    def values_at(self, samples: Samples) -> Table:
        """Return the numbers that the student wrote, at these samples."""
        return np.asarray(_values([self.entries], samples)[0])

    @property
    def is_zero(self) -> bool:
        """True if the row moves nothing: all four cells are readable and 0."""
        return not self.values.any()


@dataclass(frozen=True, slots=True)
class StudentTable:
    """A table as read: its rows and their numbers ``(rows, 4, SAMPLES)``.

    ``convention`` is the convention that the answer names, or None. ``reread`` reads the table with
    its columns in another order; it is None if the columns of a pasted table have headers.
    ``named`` is true if the cells were typed one by one into the columns of a grid.
    """

    rows: tuple[StudentRow, ...]
    values: Table
    convention: Convention | None
    findings: tuple[Finding, ...] = ()
    reread: "Reread | None" = field(default=None, compare=False)
    named: bool = False


# A function that reads a table with its columns in another order of "a", "alpha", "d", "theta".
Reread: TypeAlias = Callable[[Sequence[str]], StudentTable]


def without_empty_end(table: StudentTable, joints: int, asked: int) -> StudentTable:
    """Return the table without empty rows at its end; the rows of all joints are kept.

    A table with more rows than ``asked`` is unchanged.
    """
    # A table that is correct in the other convention may have one row fewer than the form. Such a
    # table is recognized only without the empty row at its end. An extra empty row costs as much as
    # an extra wrong row.
    if len(table.rows) > asked:
        return table
    written = [i for i, row in enumerate(table.rows) if not row.is_missing]
    kept = max(joints, written[-1] + 1) if written else len(table.rows)
    return replace(table, rows=table.rows[:kept], values=table.values[:kept])


def values_of(rows: Sequence[StudentRow]) -> Table:
    """Return the numbers of the rows, ``(rows, 4, SAMPLES)``; NaN for an unreadable cell."""
    return np.array([row.values for row in rows])


def table_values(rows: Sequence[StudentRow], samples: Samples) -> Table:
    """Return the numbers that the student wrote, at these samples: ``(rows, 4, samples)``."""
    return _values([row.entries for row in rows], samples)


# The entry for blank cells and dashes: they share one message.
EMPTY = Entry(
    None,
    Verdict.MISSING,
    (
        reading_error(
            "missing", say("Empty cells and dashes have no value: write 0 where a parameter is 0.")
        ),
    ),
)
ZERO = Entry(
    read_expression(0, Vocabulary([])),
    findings=(
        Finding(
            "empty_cells",
            say("Empty cells and dashes were read as 0."),
            severity=Severity.INFO,
            reading=True,
        ),
    ),
)

# The entry of a cell whose number was computed instead of read.
COMPUTED = Entry(read_expression(0, Vocabulary([])))
# The entry of a cell whose number is wrong in any frames, to see what the other cells are worth.
GIVEN_UP = Entry(read_expression(0, Vocabulary([])))


def computed_row(values: Table, entry: Entry = COMPUTED) -> StudentRow:
    """Return a row with the numbers ``(4, SAMPLES)``, as if a student had submitted them."""
    return StudentRow((entry,) * len(COLUMNS), values)


# --- Read a table, in JSON or pasted text


CONVENTION_NAMES: Mapping[str, Convention] = {
    "standard": Convention.STANDARD,
    "distal": Convention.STANDARD,
    "classic": Convention.STANDARD,
    "modified": Convention.MODIFIED,
    "proximal": Convention.MODIFIED,
    "craig": Convention.MODIFIED,
}

_NO_ROWS: Table = np.empty((0, len(COLUMNS), 0))


def read_table(
    answer: object,
    reader: Reader,
    order: Sequence[str] = COLUMNS,
    *,
    empty_is_zero: bool = False,
) -> StudentTable:
    """Read a table in JSON or pasted text; columns without names are in ``order``.

    The answer is ``{"rows": [{"a", "alpha", "d", "theta"} …], "convention"?}`` or has one of the
    other shapes that ``canonical_table`` accepts. A cell that is empty or a dash is missing; with
    ``empty_is_zero`` it is 0 if another cell of its row is not empty. An unreadable row or cell
    affects only itself. Raises UnreadableAnswerError if there are no rows.
    """
    if isinstance(answer, str):
        answer = {"rows": answer}
    if isinstance(answer, Mapping) and isinstance(answer.get("rows"), str):
        convention, findings = _convention(answer.get("convention"))
        table = _pasted(answer["rows"], reader, empty_is_zero=empty_is_zero)
        convention = convention or table.convention
        return replace(table, convention=convention, findings=(*findings, *table.findings))
    is_unnamed = has_unnamed_columns(answer)
    written, answer = answer, canonical_table(answer, order)
    if not isinstance(answer, Mapping) or not isinstance(answer.get("rows"), list):
        raise UnreadableAnswerError(_NO_TABLE if isinstance(answer, Mapping) else _NOT_ROWS)
    rows = answer["rows"]
    if len(rows) > MAX_ROWS:
        raise UnreadableAnswerError(_too_many_rows(len(rows)))
    convention, findings = _convention(answer.get("convention"))
    entries = [_with_empty_cells(row, empty_is_zero) for row in _entries(rows, reader)]

    def reread(other: Sequence[str]) -> StudentTable:
        again = written
        if not is_unnamed:
            again = {"rows": [_under_other_names(row, other) for row in rows]}
        try:
            return read_table(again, _with_own_budget(reader), other, empty_is_zero=empty_is_zero)
        except UnreadableAnswerError:
            return StudentTable((), _NO_ROWS, None)

    return _table(entries, convention, findings, reader, reread, named=not is_unnamed)


def _under_other_names(row: object, other: Sequence[str]) -> object:
    # ``other`` names the row's values in the order a, α, d, θ.
    if not isinstance(row, Mapping):
        return row
    return {name: row.get(column) for name, column in zip(other, COLUMNS, strict=True)}


def _with_own_budget(reader: Reader) -> Reader:
    # Reading again must not reduce the budget of the later parts. A table that exceeds the separate
    # budget has no rows in another order.
    return replace(reader, budget=WorkBudget(MAX_SYMBOLS_AGAIN))


def _pasted(text: str, reader: Reader, *, empty_is_zero: bool) -> StudentTable:
    if not text.strip():
        return StudentTable((), _NO_ROWS, None)
    try:
        pasted = read_pasted_table(text, reader)
    except GridError as error:
        raise UnreadableAnswerError(from_grid_error(error, text)) from error
    if len(pasted.rows) > MAX_ROWS:
        raise UnreadableAnswerError(_too_many_rows(len(pasted.rows)))

    def read(pasted: PastedTable, reader: Reader) -> StudentTable:
        rows = [_with_empty_cells(row, empty_is_zero) for row in entries_of(pasted, reader)]
        convention = CONVENTION_NAMES[pasted.convention] if pasted.convention else None
        return _table(rows, convention, pasted.findings, reader)

    def reread(other: Sequence[str]) -> StudentTable:
        separate = _with_own_budget(reader)
        if pasted.grid is None:
            return StudentTable((), _NO_ROWS, None)
        try:
            return read(table_of(pasted.grid, separate, other), separate)
        except GridError:
            return StudentTable((), _NO_ROWS, None)

    table = read(pasted, reader)
    return table if pasted.is_named else replace(table, reread=reread)


def _entries(rows: Sequence[object], reader: Reader) -> list[tuple[Entry, ...]]:
    cells = [_cells(row) for row in rows]
    return [
        memoized_row(row, reader) or read_row(row, _number_of_row(i, cells, reader), reader)
        for i, row in enumerate(cells)
    ]


def _number_of_row(i: int, cells: Sequence[Sequence[object]], reader: Reader) -> int | None:
    first = first_number(cells, reader.vocabulary)
    return None if first is None else first + i


def _cells(row: object) -> list[object]:
    if row is None:
        return [None] * len(COLUMNS)
    if not isinstance(row, Mapping):
        return [_NOT_VALUES] * len(COLUMNS)
    # A row with an unknown name has values that were not read: its other cells are not missing.
    absent = None if row.keys() <= QUANTITIES.keys() else _NO_ROW
    return [row.get(column, absent) for column in COLUMNS]


def _convention(stated: object) -> tuple[Convention | None, tuple[Finding, ...]]:
    if stated is None:
        return None, ()
    name = stated.strip().lower() if isinstance(stated, str) else ""
    if name in CONVENTION_NAMES:
        return CONVENTION_NAMES[name], ()
    unknown = Finding(
        "unknown_convention",
        say('This convention is not known, so it was ignored. Write "standard" or "modified".'),
        severity=Severity.WARNING,
        reading=True,
    )
    return None, (unknown,)


def _with_empty_cells(row: tuple[Entry, ...], empty_is_zero: bool) -> tuple[Entry, ...]:
    # All empty cells and cells with a dash get the same entry.
    if all(entry.readable for entry in row):
        return row
    empty = [entry.verdict is Verdict.MISSING or _is_dash(entry) for entry in row]
    meant = ZERO if empty_is_zero and not all(empty) else EMPTY
    return tuple(meant if is_empty else entry for entry, is_empty in zip(row, empty, strict=True))


def _is_dash(entry: Entry) -> bool:
    return [finding.code for finding in entry.findings] == ["dash"]


def _table(
    read: list[tuple[Entry, ...]],
    convention: Convention | None,
    findings: tuple[Finding, ...],
    reader: Reader,
    reread: Reread | None = None,
    *,
    named: bool = False,
) -> StudentTable:
    if not read:
        return StudentTable((), _NO_ROWS, convention, findings)
    values = _values(read, reader.samples)
    rows = tuple(map(StudentRow, read, values))
    return StudentTable(rows, values, convention, findings, reread, named)


def _values(rows: Sequence[tuple[Entry, ...]], samples: Samples) -> Table:
    cells = [entry for entries in rows for entry in entries]
    if absent := samples.absent_names(entry.expression for entry in cells):
        samples = samples.with_names(absent)
    numbers = entry_values(cells, (*QUANTITIES.values(),) * len(rows), samples)
    return numbers.reshape(len(rows), len(COLUMNS), -1)


# The message for a JSON object shows the expected object; the one for a list or a value uses words.
_NO_TABLE = reading_error(
    "wrong_shape",
    say('A DH table is written {{"rows": [{{"a": …, "alpha": …, "d": …, "theta": …}}, …]}}.'),
)
_NOT_ROWS = reading_error(
    "wrong_shape", say("Write the rows of the table, each with its four values a, α, d, θ.")
)
_NO_ROW = reading_error(
    "wrong_shape", say('A row is written {{"a": …, "alpha": …, "d": …, "theta": …}}.')
)
_NOT_VALUES = reading_error("wrong_shape", say("Write the four values a, α, d, θ in this row."))


def _too_many_rows(found: int) -> Finding:
    message = say("A table has at most {most} rows; yours has {found}.", most=MAX_ROWS, found=found)
    return reading_error("too_many_rows", message)
