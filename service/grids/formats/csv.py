"""Cells separated by commas. A comma in brackets, as in atan2(y, x), separates nothing."""

from typing import Final

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.pairs import outside, pairs
from service.grids.cutting.source_text import SourceText
from service.grids.formats.delimited import split_cells


def _matches(text: str) -> bool:
    return any(text[i] == "," for i in outside(text, pairs(text)))


def _parse(source: SourceText) -> Grid:
    return grid("CSV", split_cells(source, ",", brackets=True), source.whole)


FORMAT: Final = GridFormat(_matches, _parse)
