"""Cells separated by semicolons: CSV from a spreadsheet that uses decimal commas."""

from typing import Final

from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.pairs import outside
from service.grids.cutting.source_text import SourceText
from service.grids.formats.delimited import split_cells
from service.translations import say


def _matches(text: str) -> bool:
    return ";" in text


def _parse(source: SourceText) -> Grid:
    rows = split_cells(source, ";", brackets=False)
    filled = [row for row in rows if any(cell.text.strip() for cell in row)]
    if len(filled) == 1 and any(_holds_several(cell.text.strip()) for cell in filled[0]):
        raise GridError(
            "ambiguous_separators",
            say(
                "The semicolons here may separate rows or values. Put [ ] around a MATLAB "
                "matrix, or each row on a line of its own."
            ),
            source.whole,
        )
    return grid("CSV with semicolons", rows, source.whole)


def _holds_several(cell: str) -> bool:
    return any(True for _ in outside(cell, r",\s"))


FORMAT: Final = GridFormat(_matches, _parse)
