"""Move the units in the second row of a pasted table into its headers."""

from dataclasses import replace
from typing import Final, Literal

from service.grading.reading.tables.column_headers import (
    LENGTH_OR_LABEL,
    QUANTITIES,
    THETA_OFFSET,
    read_header,
)
from service.grading.reading.tables.words import ANGLE_UNITS, METRES, in_plain_words
from service.grids import Grid, GridCell
from service.grids.cutting.source_text import joined

_KINDS: Final = {**QUANTITIES, LENGTH_OR_LABEL: "length", THETA_OFFSET: "angle"}
_BRACKETS = "()[]"
_UNIT_WORDS: Final = frozenset(
    {"unit", "units", "einheit", "einheiten", "unite", "unites", "unidad", "unidades", "单位"}
)


def with_units_in_headers(grid: Grid) -> Grid:
    """Return the table with one header ``a [m]`` for the two cells ``a`` and ``(m)``.

    A table without a row of units is returned unchanged.
    """
    # All cells of the second row, or of a last row "Unit", must be units of a parameter, or empty.
    if len(grid.rows) < 3:
        return grid
    first, *body = grid.rows
    if _says_unit(body[-1][0].text):
        body = [body[-1], *body[:-1]]
    second, *body = body
    if len(first) != len(second):
        return grid
    headers = [read_header(cell.text) for cell in first]
    columns = [header.column if header and not header.unit else "" for header in headers]
    units = [_unit_of(column, cell) for column, cell in zip(columns, second, strict=True)]
    if None in units or not any(units):
        return grid
    merged = tuple(
        _with_unit(header, unit) if unit else header
        for header, unit in zip(first, units, strict=True)
    )
    return replace(grid, rows=(merged, *body))


def _says_unit(text: str) -> bool:
    return in_plain_words(text).strip(f"{_BRACKETS} ") in _UNIT_WORDS


def _unit_of(column: str, cell: GridCell) -> GridCell | Literal[""] | None:
    """Return the cell if it is a unit of the parameter ``column``; None if it is anything else.

    Return an empty text for an empty cell, and for the label of the row of units.
    """
    if not cell.text.strip("-– ") or (column in ("", "label") and _says_unit(cell.text)):
        return ""
    unit = in_plain_words(cell.text).strip(f"{_BRACKETS} ")
    units = {"angle": ANGLE_UNITS, "length": METRES}.get(_KINDS.get(column, ""), {})
    return cell if unit in units else None


def _with_unit(header: GridCell, unit: GridCell) -> GridCell:
    bare = unit.strip(f"{_BRACKETS} ")
    nothing = bare.cut(0, 0)
    return joined([header, nothing.spelled(" ["), bare, nothing.spelled("]")], header.at)
