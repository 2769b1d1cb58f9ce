"""A DH table as handed in, JSON or pasted text -> its rows and their numbers."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

from service.expressions import Expression, Vocabulary
from service.expressions import read as read_expression
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error
from service.grading.numerics.samples import Samples
from service.grading.reading.absent_variables import absent_names
from service.grading.reading.entry import Entry, Reader, entry_values
from service.grading.reading.pasted import from_grid_error, pasted_grid, pasted_robot
from service.grading.reading.tables.cell_names import first_number
from service.grading.reading.tables.column_headers import QUANTITIES
from service.grading.reading.tables.pasted_table import (
    PastedTable,
    entries_of,
    table_of,
    table_of_robot,
)
from service.grading.reading.tables.row_entries import read_row, remembered_row
from service.grading.reading.tables.table_json import canonical_table, has_unnamed_columns
from service.grading.report import Severity, Verdict
from service.grading.work_budget import MAX_SYMBOLS_AGAIN, WorkBudget
from service.grids import GridError
from service.kinematics.chain import COLUMNS, Table
from service.kinematics.dh import Convention

IS_ANGLE = np.array([QUANTITIES[column] == "angle" for column in COLUMNS])
MAX_ROWS = 12

CONVENTION_NAMES: Mapping[str, Convention] = {
    "standard": Convention.STANDARD,
    "distal": Convention.STANDARD,
    "classic": Convention.STANDARD,
    "modified": Convention.MODIFIED,
    "proximal": Convention.MODIFIED,
    "craig": Convention.MODIFIED,
}


@dataclass(frozen=True, slots=True)
class StudentRow:
    """One row as read: an entry for each of a, α, d, θ, and their numbers ``(4, SAMPLES)``.

    A number is NaN where a cell could not be read. Where ``values`` are what rounded angles stand
    for, ``as_written`` are those that were written.
    """

    entries: tuple[Entry, ...]
    values: Table
    as_written: Table | None = None

    @property
    def is_exact(self) -> bool:
        """Whether the values are those that were written."""
        return self.as_written is None

    @property
    def handed_in(self) -> Table:
        """The numbers as they were handed in."""
        return self.values if self.as_written is None else self.as_written

    @property
    def expressions(self) -> list[Expression | None]:
        """The expressions of the cells; None where nothing could be read."""
        return [entry.expression for entry in self.entries]

    @property
    def has_decimal(self) -> bool:
        """Whether a decimal stands in any cell."""
        for entry in self.entries:
            if entry.expression is not None and entry.expression.has_decimal:
                return True
        return False

    def values_at(self, samples: Samples) -> Table:
        """The numbers at other samples, as they were handed in."""
        return np.asarray(_values([self.entries], samples)[0])

    @property
    def is_zero(self) -> bool:
        """Whether the row moves nothing: all four cells are read and are 0."""
        return not self.values.any()


@dataclass(frozen=True, slots=True)
class StudentTable:
    """A table as read: its rows, and the numbers of all of them, ``(rows, 4, SAMPLES)``.

    ``convention`` is what the answer itself says, if it says so. ``reread`` reads its columns in
    another order: where nothing but their order says what they hold, or where the cells are
    ``named``, typed one by one under the heads of a grid.
    """

    rows: tuple[StudentRow, ...]
    values: Table
    convention: Convention | None
    findings: tuple[Finding, ...] = ()
    reread: "Reread | None" = field(default=None, compare=False)
    named: bool = False


# Reads a table with its columns in another order of "a", "alpha", "d" and "theta".
Reread: TypeAlias = Callable[[Sequence[str]], StudentTable]


def read_table(
    answer: object,
    reader: Reader,
    order: Sequence[str] = COLUMNS,
    *,
    empty_is_zero: bool = False,
) -> StudentTable:
    """The table in a JSON answer ``{"rows": [{"a", "alpha", "d", "theta"} …], "convention"?}``.

    It may have other shapes that mean the same (``table_json``), and it, or its rows, may be
    pasted text. Columns without names are in ``order``. A cell that is empty or holds a dash alone
    is missing, or 0 with ``empty_is_zero`` where anything is written in its row.

    Raises UnreadableAnswerError where the answer has no rows at all; a row or cell that cannot be
    read costs only itself.
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
            return read_table(again, _afresh(reader), other, empty_is_zero=empty_is_zero)
        except UnreadableAnswerError:
            return StudentTable((), _NO_ROWS, None)

    return _table(entries, convention, findings, reader, reread, named=not is_unnamed)


def _under_other_names(row: object, other: Sequence[str]) -> object:
    """A row whose cells, in the order a, α, d, θ, are named in another order."""
    if not isinstance(row, Mapping):
        return row
    return {name: row.get(column) for name, column in zip(other, COLUMNS, strict=True)}


def _afresh(reader: Reader) -> Reader:
    """The reader with a budget of its own, for a table that is read in another order.

    What this costs must not be missing for the parts that follow. A table that is too long for it
    has no rows in another order.
    """
    return replace(reader, budget=WorkBudget(MAX_SYMBOLS_AGAIN))


def _pasted(text: str, reader: Reader, *, empty_is_zero: bool) -> StudentTable:
    """The pasted table, without rows for blanks alone. Raises UnreadableAnswerError."""
    if not text.strip():
        return StudentTable((), _NO_ROWS, None)
    try:
        robot = pasted_robot(text, reader)
        grid = robot.grid if robot else pasted_grid(text, reader)
        pasted = table_of_robot(robot, reader) if robot else table_of(grid, reader)
    except GridError as error:
        raise UnreadableAnswerError(from_grid_error(error)) from error
    if len(pasted.rows) > MAX_ROWS:
        raise UnreadableAnswerError(_too_many_rows(len(pasted.rows)))

    def read(pasted: PastedTable, reader: Reader) -> StudentTable:
        rows = [_with_empty_cells(row, empty_is_zero) for row in entries_of(pasted, reader)]
        convention = CONVENTION_NAMES[pasted.convention] if pasted.convention else None
        return _table(rows, convention, pasted.findings, reader)

    def reread(other: Sequence[str]) -> StudentTable:
        afresh = _afresh(reader)
        try:
            return read(table_of(grid, afresh, other), afresh)
        except GridError:
            return StudentTable((), _NO_ROWS, None)

    table = read(pasted, reader)
    return table if pasted.is_named else replace(table, reread=reread)


def _with_empty_cells(row: tuple[Entry, ...], empty_is_zero: bool) -> tuple[Entry, ...]:
    """The row with its empty cells alike, whether they are blank or hold a dash."""
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


# The cells of a table that are blank or hold a dash: the message is one for all of them.
EMPTY = Entry(
    None,
    Verdict.MISSING,
    (
        reading_error(
            "missing", "Empty cells and dashes have no value: write 0 where a parameter is 0."
        ),
    ),
)
ZERO = Entry(
    read_expression(0, Vocabulary([])),
    findings=(
        Finding(
            "empty_cells",
            "Empty cells and dashes were read as 0.",
            severity=Severity.INFO,
            reading=True,
        ),
    ),
)

# A number that was computed stands for a cell that was read.
COMPUTED = Entry(read_expression(0, Vocabulary([])))


def computed_row(values: Table) -> StudentRow:
    """A row as if somebody had handed in these numbers, ``(4, SAMPLES)``."""
    return StudentRow((COMPUTED,) * len(COLUMNS), values)


_NO_ROWS: Table = np.empty((0, len(COLUMNS), 0))


def _values(rows: Sequence[tuple[Entry, ...]], samples: Samples) -> Table:
    cells = [entry for entries in rows for entry in entries]
    if absent := absent_names((entry.expression for entry in cells), samples):
        samples = samples.with_names(absent)
    numbers = entry_values(cells, (*QUANTITIES.values(),) * len(rows), samples)
    return numbers.reshape(len(rows), len(COLUMNS), -1)


def _too_many_rows(found: int) -> Finding:
    message = f"A table has at most {MAX_ROWS} rows; yours has {found}."
    return reading_error("too_many_rows", message)


def _convention(stated: object) -> tuple[Convention | None, tuple[Finding, ...]]:
    if stated is None:
        return None, ()
    name = stated.strip().lower() if isinstance(stated, str) else ""
    if name in CONVENTION_NAMES:
        return CONVENTION_NAMES[name], ()
    unknown = Finding(
        "unknown_convention",
        'This convention is not known, so it was ignored. Write "standard" or "modified".',
        severity=Severity.WARNING,
        reading=True,
    )
    return None, (unknown,)


def _entries(rows: Sequence[object], reader: Reader) -> list[tuple[Entry, ...]]:
    """The entries of each row."""
    cells = [_cells(row) for row in rows]
    first = first_number(cells, reader.vocabulary)
    return [
        _row_entries(row, None if first is None else first + i, reader)
        for i, row in enumerate(cells)
    ]


def _cells(row: object) -> list[object]:
    """The values of a, α, d, θ; a finding where nobody can say what the value is."""
    if row is None:
        return [None] * len(COLUMNS)
    if not isinstance(row, Mapping):
        return [_NOT_VALUES] * len(COLUMNS)
    # A value under an unknown name must not pass for a missing one.
    absent = None if row.keys() <= QUANTITIES.keys() else _NO_ROW
    return [row.get(column, absent) for column in COLUMNS]


def _row_entries(cells: list[object], number: int | None, reader: Reader) -> tuple[Entry, ...]:
    known = remembered_row(cells, number, reader)
    return read_row(cells, number, reader) if known is None else known


# An object is answered with the one that is asked for, a list or a single value in words.
_NO_TABLE = reading_error(
    "wrong_shape", 'A DH table is written {"rows": [{"a": …, "alpha": …, "d": …, "theta": …}, …]}.'
)
_NOT_ROWS = reading_error(
    "wrong_shape", "Write the rows of the table, each with its four values a, α, d, θ."
)
_NO_ROW = reading_error("wrong_shape", 'A row is written {"a": …, "alpha": …, "d": …, "theta": …}.')
_NOT_VALUES = reading_error("wrong_shape", "Write the four values a, α, d, θ in this row.")


def table_values(rows: Sequence[StudentRow], samples: Samples) -> Table:
    """The numbers of the rows at other samples, as they were handed in: ``(rows, 4, samples)``."""
    return _values([row.entries for row in rows], samples)


def values_of(rows: Sequence[StudentRow]) -> Table:
    """The numbers of the rows, ``(rows, 4, SAMPLES)``; NaN where a cell could not be read."""
    return np.array([row.values for row in rows])
