"""Move the units in the second row of a pasted table into its headers."""

from dataclasses import replace

from service.grading.reading.tables.column_headers import QUANTITIES, read_header
from service.grading.reading.tables.words import ANGLE_UNITS, METRES, in_plain_words
from service.grids import Grid, GridCell
from service.grids.cutting.source_text import joined

_BRACKETS = "()[]"


def with_units_in_headers(grid: Grid) -> Grid:
    """Return the table with one header ``a [m]`` for the two cells ``a`` and ``(m)``.

    Other tables are unchanged.
    """
    # All cells of the second row must be units of a parameter, or empty.
    if len(grid.rows) < 3 or len(grid.rows[0]) != len(grid.rows[1]):
        return grid
    first, second, *body = grid.rows
    headers = [read_header(cell.text) for cell in first]
    columns = [header.column if header and not header.unit else "" for header in headers]
    pairs = zip(columns, second, strict=True)
    filled = [(column, cell) for column, cell in pairs if cell.text.strip("-– ")]
    if not filled or not all(_is_unit_of(column, cell.text) for column, cell in filled):
        return grid
    merged = tuple(
        _with_unit(header, unit) if unit.text.strip("-– ") else header
        for header, unit in zip(first, second, strict=True)
    )
    return replace(grid, rows=(merged, *body))


def _is_unit_of(column: str, text: str) -> bool:
    unit = in_plain_words(text).strip(f"{_BRACKETS} ")
    units = {"angle": ANGLE_UNITS, "length": METRES}.get(QUANTITIES.get(column, ""), {})
    return unit in units


def _with_unit(header: GridCell, unit: GridCell) -> GridCell:
    bare = unit.strip(f"{_BRACKETS} ")
    nothing = bare.cut(0, 0)
    return joined([header, nothing.spelled(" ["), bare, nothing.spelled("]")], header.at)
