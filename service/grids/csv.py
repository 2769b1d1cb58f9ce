"""Cells between commas. The comma of atan2(y, x), in brackets, separates nothing."""

from typing import Final

from service.grids.delimited import split_cells
from service.grids.grid import Grid, GridFormat, grid
from service.grids.pairs import pairs
from service.grids.source_text import SourceText


def _matches(text: str) -> bool:
    ends = pairs(text)
    i = 0
    while i < len(text):
        if text[i] == ",":
            return True
        i = ends.get(i, i + 1)
    return False


def _parse(source: SourceText) -> Grid:
    return grid("CSV", split_cells(source, ",", brackets=True), source.whole)


FORMAT: Final = GridFormat("CSV", _matches, _parse)
