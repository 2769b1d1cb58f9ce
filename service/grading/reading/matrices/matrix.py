"""Read a submitted matrix, nested lists or pasted text, as entries and their values."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from service.expressions import Expression, Kind
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error
from service.grading.numerics.samples import Samples
from service.grading.reading.entry import (
    MISSING,
    UNREADABLE,
    Entry,
    Reader,
    entry_values,
    from_note,
    unreadable,
)
from service.grading.reading.matrices.matrix_entry_names import misnamed_entry
from service.grading.reading.pasted import from_grid_error, pasted_grid, place_of, placed
from service.grading.reading.several_answers import FoundAnswer, read_once
from service.grading.reading.unit_comments import refuse_other_lengths
from service.grading.report import Verdict
from service.grids import Grid, GridCell, GridError
from service.grids.matrices.identity import ANY_SIZE
from service.kinematics.transforms import Numbers
from service.translations import say

Quantities = Sequence[Sequence[Kind]]


@dataclass(frozen=True, slots=True)
class StudentMatrix:
    """A matrix as read: its entries and their values ``(rows, columns, SAMPLES)``.

    A value is NaN if its entry is unreadable or undefined. ``findings`` are notes on how the whole
    matrix was read.
    """

    entries: list[list[Entry]]
    quantities: Quantities
    values: Numbers
    findings: tuple[Finding, ...] = ()

    @property
    def expressions(self) -> list[Expression | None]:
        """The expressions of the entries, row by row; None for an unreadable entry."""
        return [entry.expression for row in self.entries for entry in row]

    @property
    def with_zeros(self) -> Numbers:
        """The values, with 0 in empty entries."""
        empty = [[entry.verdict is Verdict.MISSING for entry in row] for row in self.entries]
        return np.where(np.array(empty)[..., None], 0.0, self.values)

    def values_at(self, samples: Samples) -> Numbers:
        """Return the values of the entries at these samples (random joint values)."""
        return matrix_values(self.entries, self.quantities, samples)


def read_matrix(answer: object, quantities: Quantities, reader: Reader) -> StudentMatrix:
    """Read the matrix in a nested list or a pasted text.

    Raises UnreadableAnswerError if there are no rows, or too many.
    """
    # Omitted rows at the end are missing.
    # A row of the wrong length is unreadable, because its entries are ambiguous.
    if isinstance(answer, str) and answer.strip():
        return _pasted(answer, quantities, reader)
    return matrix_of_entries(_entries(answer, quantities, reader), quantities, reader)


def matrix_of_grid(grid: Grid, quantities: Quantities, reader: Reader) -> StudentMatrix:
    """Read the matrix in a pasted grid. Raises UnreadableAnswerError if its size is wrong."""
    cells = _cells(grid, quantities)
    if cells is None:
        span = grid.rows[0][0].whole[0], grid.rows[-1][-1].whole[1]
        raise UnreadableAnswerError(_of_wrong_size(grid.size, quantities, span))
    matrix = matrix_of_entries(_of_cells(cells, quantities, reader), quantities, reader)
    return replace(matrix, findings=tuple(map(from_note, grid.notes)))


def unreadable_matrix(finding: Finding, quantities: Quantities, reader: Reader) -> StudentMatrix:
    """Return an unreadable matrix; its first entry has the message."""
    entries = [_unreadable_row(None, kinds) for kinds in quantities]
    entries[0] = _unreadable_row(finding, quantities[0])
    return matrix_of_entries(entries, quantities, reader)


def matrix_of_entries(
    entries: list[list[Entry]], quantities: Quantities, reader: Reader
) -> StudentMatrix:
    """Return the matrix with these rows."""
    # Omitted rows at the end are missing.
    entries = [*entries, *([MISSING] * len(row) for row in quantities[len(entries) :])]
    return StudentMatrix(entries, quantities, matrix_values(entries, quantities, reader.samples))


def matrix_values(entries: list[list[Entry]], quantities: Quantities, samples: Samples) -> Numbers:
    """Return the values of a matrix's entries, ``(rows, columns, SAMPLES)``; NaN if unreadable."""
    flat = entry_values(list(chain(*entries)), list(chain(*quantities)), samples)
    return flat.reshape(len(entries), len(quantities[0]), -1)


def _entries(answer: object, quantities: Quantities, reader: Reader) -> list[list[Entry]]:
    if isinstance(answer, str):
        return []
    if not isinstance(answer, list) or not answer or len(answer) > len(quantities):
        raise UnreadableAnswerError(_of_wrong_size("", quantities))
    return [_row(row, i, quantities, reader) for i, row in enumerate(answer)]


def _row(row: object, i: int, quantities: Quantities, reader: Reader) -> list[Entry]:
    kinds = quantities[i]
    if _is_empty(row):
        return [MISSING] * len(kinds)
    if not isinstance(row, list) or len(row) != len(kinds):
        return _of_wrong_length(len(row) if isinstance(row, list) else None, len(kinds))
    return [_entry(raw, (i, j), quantities, reader) for j, raw in enumerate(row)]


def _is_empty(row: object) -> bool:
    entries = row if isinstance(row, list) else [row]
    return all(each is None or (isinstance(each, str) and not each.strip()) for each in entries)


def _entry(raw: object, place: tuple[int, int], quantities: Quantities, reader: Reader) -> Entry:
    # An entry with the name of another place is unreadable.
    i, j = place
    entry = reader.read(raw, quantities[i][j])
    if entry.findings:
        size = len(quantities), len(quantities[0])
        wrong = misnamed_entry(raw, place, size, reader.vocabulary)
        return unreadable(wrong) if wrong else entry
    return entry


def _of_wrong_size(
    found: str, quantities: Quantities, span: tuple[int, int] | None = None
) -> Finding:
    # ``found`` is "" if there is no matrix.
    rows, columns = len(quantities), len(quantities[0])
    message = say("Write {rows} rows with {columns} entries each.", rows=rows, columns=columns)
    if found:
        message = say(
            "Write {rows} rows with {columns} entries each; yours is {size}.",
            rows=rows,
            columns=columns,
            size=found,
        )
    return reading_error("wrong_shape", message, span)


def _of_wrong_length(
    found: int | None, wanted: int, span: tuple[int, int] | None = None
) -> list[Entry]:
    # ``found`` is None if the row is not a list.
    message = say("Write {wanted} entries in this row.", wanted=wanted)
    if found is not None:
        message = say(
            "Write {wanted} entries in this row; it has {found}.", wanted=wanted, found=found
        )
    return _unreadable_row(reading_error("row_length", message, span), [""] * wanted)


def _unreadable_row(finding: Finding | None, cells: Sequence[object]) -> list[Entry]:
    # Only the first entry has the finding, so that it is shown once.
    first = unreadable(finding) if finding else UNREADABLE
    return [first, *[UNREADABLE] * (len(cells) - 1)]


def _pasted(text: str, quantities: Quantities, reader: Reader) -> StudentMatrix:
    def find(piece: str, reader: Reader) -> FoundAnswer | None:
        cells = _cells(_grid(piece, quantities, reader), quantities)
        if cells is None or [len(row) for row in cells] != [len(row) for row in quantities]:
            return None
        texts = tuple("".join(cell.text.split()) for row in cells for cell in row)
        entries = tuple(chain.from_iterable(_of_cells(cells, quantities, reader)))
        return FoundAnswer(texts, entries, (*chain.from_iterable(quantities),), is_whole=True)

    def is_one(grid: Grid) -> bool:
        return _cells(grid, quantities) is not None

    try:
        grid, notes = read_once(
            text, lambda piece: _grid(piece, quantities, reader), is_one, find, reader
        )
    except GridError as error:
        raise UnreadableAnswerError(from_grid_error(error, text)) from error
    return matrix_of_grid(replace(grid, notes=(*grid.notes, *notes)), quantities, reader)


def _grid(text: str, quantities: Quantities, reader: Reader) -> Grid:
    refuse_other_lengths(text, chain.from_iterable(quantities), reader)
    return pasted_grid(text, reader)


def _cells(grid: Grid, quantities: Quantities) -> Sequence[Sequence[GridCell]] | None:
    # None if the grid has another size.
    height, width = len(quantities), len(quantities[0])
    grid = grid.with_empty_rows(height).without_half_row(height)
    if grid.format == ANY_SIZE and height == width:
        grid = replace(grid, rows=tuple(row[:width] for row in grid.rows[:height]))
    if len(grid.rows) > height or all(len(row) != width for row in grid.rows):
        return None
    return grid.rows


def _of_cells(
    cells: Sequence[Sequence[GridCell]], quantities: Quantities, reader: Reader
) -> list[list[Entry]]:
    return [_pasted_row(row, i, quantities, reader) for i, row in enumerate(cells)]


def _pasted_row(
    row: Sequence[GridCell], i: int, quantities: Quantities, reader: Reader
) -> list[Entry]:
    width = len(quantities[i])
    if len(row) != width:
        return _of_wrong_length(len(row), width, place_of(row))
    return [
        placed(_entry(cell.text, (i, j), quantities, reader), cell) for j, cell in enumerate(row)
    ]
