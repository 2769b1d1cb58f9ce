"""Cells separated by tabs, the clipboard format of spreadsheets and web pages."""

from typing import Final

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.source_text import SourceText
from service.grids.formats.delimited import split_cells
from service.regex import regex

# A tab after a comma, or at the beginning of each line, is only layout.
_TAB: Final = regex(r"[^\s,;][^\S\n\t]*\t")


def _matches(text: str) -> bool:
    return _TAB.search(text) is not None


def _parse(source: SourceText) -> Grid:
    return grid("TSV", split_cells(source, "\t", brackets=False), source.whole)


FORMAT: Final = GridFormat(_matches, _parse)
