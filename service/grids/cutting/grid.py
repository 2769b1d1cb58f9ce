"""The grid that is read from a pasted text, and the protocol of all formats."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final

from service.expressions.errors import Note, Span, TextError
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.source_text import SourceText
from service.regex import regex
from service.translations import say

GridCell = SourceText
# Quotation marks of word processors around a whole cell.
_QUOTED: Final = regex(r"„[^„“”]+[“”]|“[^“”]+”|«[^«»]+»|»[^«»]+«")
# The remark that a value is the variable of its joint.
_VARIABLE: Final = regex(r"\s*[(\[](?:joint )?(?:variable|var\.?)[)\]]$", re.IGNORECASE)
_NUMBER: Final = regex(r"\d{1,2}\Z")
Rows = Sequence[Sequence[GridCell]]


class GridError(TextError):
    """The pasted text is not exactly one table or matrix. ``span`` is the place of the problem."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Rows of cells; the rows may differ in length. ``format`` is the name of the text's format."""

    format: str
    rows: tuple[tuple[GridCell, ...], ...]
    notes: tuple[Note, ...] = ()
    # The empty rows with separators, each with the number of rows above it.
    empty: tuple[tuple[int, tuple[GridCell, ...]], ...] = ()

    def with_empty_rows(self, most: int) -> "Grid":
        """Return the grid with its empty rows, if it then has at most ``most`` rows.

        Otherwise the empty rows are only layout.
        """
        width = max(map(len, self.rows))
        fits = len(self.rows) + len(self.empty) <= most
        if not self.empty or not fits or any(len(row) < width for _, row in self.empty):
            return self
        rows = list(self.rows)
        for above, row in reversed(self.empty):
            rows.insert(above, row[:width])
        return replace(self, rows=tuple(rows), empty=())

    def without_half_row(self, fewest: int) -> "Grid":
        """Return the grid without a last row that was only begun, if ``fewest`` others remain.

        Such a row has only its number, and no other value.
        """
        *others, last = self.rows
        begun = [cell.text for cell in last if cell.text]
        is_short = len(last) < max(map(len, self.rows)) and last[0].text in begun
        if len(others) < fewest or not is_short or len(begun) != 1 or not _NUMBER.match(begun[0]):
            return self
        note = Note(
            "text_left_aside", say("The last row has only a number and was ignored."), last[0].whole
        )
        return replace(self, rows=tuple(others), notes=(*self.notes, note))

    @property
    def size(self) -> str:
        """The size as text: ``4 × 4``, or ``3 × 2 to 4`` if the rows differ in length."""
        shortest, longest = min(map(len, self.rows)), max(map(len, self.rows))
        if shortest == longest:
            return f"{len(self.rows)} × {longest}"
        # Translators: the size of a matrix whose rows have different lengths.
        return say(
            "{rows} × {shortest} to {longest}",
            rows=len(self.rows),
            shortest=shortest,
            longest=longest,
        )


@dataclass(frozen=True, slots=True)
class GridFormat:
    """One way to write a grid.

    ``matches`` returns True if a text seems to be in this format. ``parse`` reads the text, or
    raises GridError. Both take linear time.
    """

    # ``matches`` never raises.

    matches: Callable[[str], bool]
    parse: Callable[[SourceText], Grid]


def too_many_matrices(whole: Span) -> GridError:
    """Return the error for a text with too many matrices."""
    most = GRID_LIMITS.matrices
    message = say("A pasted text has at most {most} matrices; yours has more.", most=most)
    return GridError("too_many_matrices", message, whole)


def too_many_rows(whole: Span, found: int | None = None) -> GridError:
    """Return the error for a table with too many rows; ``found`` is their number, if known."""
    most = GRID_LIMITS.rows - 1
    if found is None:
        message = say("A table has at most {most} rows below a header; yours has more.", most=most)
    else:
        message = say(
            "A table has at most {most} rows below a header; yours has {found} in all.",
            most=most,
            found=found,
        )
    return GridError("too_many_rows", message, whole)


def too_many_cells(whole: Span) -> GridError:
    """Return the error for a text with too many separators."""
    message = say(
        "This has more than {most:,} commas, tabs, bars and line ends; "
        "paste only the table or matrix.",
        most=GRID_LIMITS.separators,
    )
    return GridError("too_many_cells", message, whole)


def grid(name: str, rows: Rows, whole: Span, notes: Iterable[Note] = ()) -> Grid:
    """Return a grid of these rows, without empty rows and empty outer columns.

    Raises GridError if all cells are empty or the grid is too large.
    """
    tidied = [[tidy(cell) for cell in row] for row in rows]
    filled: list[list[GridCell]] = []
    empty: list[tuple[int, tuple[GridCell, ...]]] = []
    for row in tidied:
        if any(cell.text for cell in row):
            filled.append(row)
        elif len(row) > 1:
            empty.append((len(filled), tuple(row)))
    if not filled:
        raise GridError("empty", say("All cells of this table or matrix are empty."), whole)
    filled = _without_empty_columns(filled)
    if len(filled) > GRID_LIMITS.rows:
        raise too_many_rows(whole, len(filled))
    widest = max(map(len, filled))
    if widest > GRID_LIMITS.columns:
        message = say(
            "A table has at most {most} columns; yours has {found}.",
            most=GRID_LIMITS.columns,
            found=widest,
        )
        raise GridError("too_many_columns", message, whole)
    return Grid(name, tuple(map(tuple, filled)), tuple(notes), tuple(empty))


def tidy(cell: GridCell) -> GridCell:
    """Return the cell without outer blanks and style marks: $…$, `…`, „…“."""
    cell = cell.strip()
    if _QUOTED.fullmatch(cell.text):
        cell = cell.cut(1, len(cell.text) - 1).strip()
    for mark in ("`", "**"):
        if len(cell.text) > 2 * len(mark) and cell.text.startswith(mark):
            inner = cell.cut(len(mark), len(cell.text) - len(mark))
            if cell.text.endswith(mark) and mark not in inner.text:
                cell = inner.strip()
    if "$" in cell.text and cell.text.count("$") % 2 == 0 and "\\$" not in cell.text:
        # Replace each $ by a blank, so that $a$$b$ does not become one name.
        cell = replace(cell, text=cell.text.replace("$", " ")).strip()
    if variable := _VARIABLE.search(cell.text[-20:]):
        cell = cell.cut(0, len(cell.text) - len(variable[0]))
    if cell.text.startswith("\\(") and cell.text.endswith("\\)"):
        cell = cell.cut(2, len(cell.text) - 2).strip()
    return cell


def _without_empty_columns(rows: list[list[GridCell]]) -> list[list[GridCell]]:
    while all(row and not row[-1].text for row in rows if len(row) == max(map(len, rows))):
        widest = max(map(len, rows))
        rows = [row[:-1] if len(row) == widest else row for row in rows]
    while len({len(row) for row in rows}) == 1 and not any(row[0].text for row in rows):
        rows = [row[1:] for row in rows]
    return rows
