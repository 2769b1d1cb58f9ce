"""Cells one below the other, as PDF readers and chats copy a table: each line is one cell."""

import re
from typing import Final

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.source_text import SourceText
from service.regex import regex

_HEADER: Final = regex(
    r"\$?\\?(?:(?P<a>a)|(?P<alpha>alpha|α)|(?P<d>d)|(?P<theta>theta|θ|ϑ))_?\{?[ijᵢ]?\}?\$?",
    re.IGNORECASE,
)
_COUNT: Final = 4
_ROW: Final = regex(r"(?:[^\W\d_]{1,20} ?)?\d{1,2}")


def _rows(source: SourceText) -> list[list[SourceText]]:
    lines = [line for line in map(SourceText.strip, source.lines()) if line.text]
    for width in (_COUNT, _COUNT + 1):
        headers = [_HEADER.fullmatch(line.text) for line in lines[width - _COUNT : width]]
        labels = [line.text for line in lines[width::width]] if width > _COUNT else []
        is_whole = len(lines) > width and len(lines) % width == 0
        if is_whole and len({name and name.lastgroup for name in headers} - {None}) == _COUNT:
            rows = [lines[i : i + width] for i in range(0, len(lines), width)]
            return rows if all(map(_ROW.fullmatch, labels)) else []
    return []


def _parse(source: SourceText) -> Grid:
    return grid("stacked", _rows(source), source.whole)


FORMAT: Final = GridFormat(lambda text: bool(_rows(SourceText.of(text))), _parse)
