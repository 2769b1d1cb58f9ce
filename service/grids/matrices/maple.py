"""Maple's matrices in angle brackets: by rows <<a|b>, <c|d>>, by columns <<a, c>|<b, d>>."""

import re
from itertools import zip_longest
from typing import Final

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.pairs import split
from service.grids.cutting.source_text import SourceText
from service.grids.scripts.program_text import TAIL, after_names
from service.regex import regex

_MATRIX: Final = regex(
    r"<\s*<[^<>,;]{1,800}>(?:\s*[,;]\s*<[^<>,;]{1,800}>){1,12}\s*>"
    r"|(?P<columns><\s*<[^<>|]{1,800}>(?:\s*\|\s*<[^<>|]{1,800}>){1,12}\s*>)"
)
_LINE: Final = regex(r"<([^<>]+)>")


def _found(text: str) -> re.Match[str] | None:
    return _MATRIX.fullmatch(text[after_names(text) :].strip(TAIL)) if "<" in text else None


def _parse(source: SourceText) -> Grid:
    found = _found(source.text)
    by_columns = found is not None and found["columns"] is not None
    lines = [source.cut(*line.span(1)) for line in _LINE.finditer(source.text)]
    rows = [split(line, ",;" if by_columns else "|") for line in lines]
    if by_columns:
        rows = [list(row) for row in zip_longest(*rows, fillvalue=source.cut(0, 0))]
    return grid("Maple", rows, source.whole)


FORMAT: Final = GridFormat(lambda text: _found(text) is not None, _parse)
