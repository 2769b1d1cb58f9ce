"""Remove a separator after the last cell of a row, which separates nothing."""

import re
from collections.abc import Iterator
from typing import Final

from service.grids.cutting.blanks import split_blanks
from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex

_SIGNS: Final = "\t;,"
_BARS: Final = "|│┃║"
_END: Final = regex(r"[\t;,](?=[ \t]*(?:[\r\n\x85\u2028\u2029]|\Z))")
# A list of values in lines has fewer values in a line than the smallest matrix.
_FEWEST_CELLS: Final = 3


def without_last_signs(source: SourceText) -> SourceText:
    """Return the text without the tabs, semicolons or commas that are only at the ends of lines.

    A sign stays if it may separate cells or if the text has no other separators.
    """
    for sign in _SIGNS:
        ends = [end for end in _END.finditer(source.text) if end[0] == sign]
        if ends and len(ends) == source.text.count(sign):
            pieces = list(_without(source, ends))
            rest = joined(pieces, source.at)
            if _has_cells(rest, sign):
                source = rest
    return source


def _without(source: SourceText, ends: list[re.Match[str]]) -> Iterator[SourceText]:
    start = 0
    for end in ends:
        yield source.cut(start, end.start())
        start = end.end()
    yield source.cut(start, len(source.text))


def _has_cells(rest: SourceText, sign: str) -> bool:
    lines = [line.strip() for line in rest.lines() if line.text.strip()]
    if any(other != sign and any(other in line.text for line in lines) for other in _SIGNS + _BARS):
        return True
    # MATLAB's rows in lines that end with semicolons have their own format.
    counts = {len(split_blanks(line).elements) for line in lines} if sign != ";" else {0}
    return len(counts) == 1 and min(counts) >= _FEWEST_CELLS
