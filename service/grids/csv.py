"""Cells between commas. The comma of atan2(y, x), in brackets, separates nothing."""

from typing import Final

from service.grids.delimited import split_cells
from service.grids.grid import Grid, GridFormat, grid
from service.grids.pairs import outside, pairs
from service.grids.source_text import SourceText


def _matches(text: str) -> bool:
    return any(text[i] == "," for i in outside(text, pairs(text)))


def _parse(source: SourceText) -> Grid:
    return grid("CSV", split_cells(source, ",", brackets=True), source.whole)


FORMAT: Final = GridFormat(_matches, _parse)
