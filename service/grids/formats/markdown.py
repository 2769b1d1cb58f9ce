"""Cells between vertical bars: tables in Markdown, and drawn tables."""

import re
from typing import Final

from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.markup import without_tags
from service.grids.cutting.source_text import SourceText
from service.translations import say

_BARS: Final = "|│┃║"
_BAR: Final = re.compile(rf"[{_BARS}]")
_SEPARATOR: Final = re.compile(rf"(?<!\\)[{_BARS}]")
_DOUBLE: Final = re.compile(r"\|\|")
_RULE: Final = re.compile(r"[\s|:+\-=_│┃║─━═┼╪╬┬┴├┤┌┐└┘╭╮╰╯┏┓┗┛┣┫┳┻╋╔╗╚╝╠╣╦╩╒╕╘╛╞╡╤╧╟╢┠┨┯┷]+")


def _matches(text: str) -> bool:
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    barred = [line for line in lines if _BAR.search(line)]
    return len(barred) > 1 or sum(text.count(bar) for bar in _BARS) > 2


def _parse(source: SourceText) -> Grid:
    rows = []
    for line in map(SourceText.strip, source.lines()):
        if not line.text or _is_rule(line.text):
            continue
        cells = _cells(line)
        if len(cells) == 1:
            message = say("This line of the table has no |; paste the table alone.")
            raise GridError("text_around", message, line.whole)
        rows.append(cells)
    return grid("Markdown", rows, source.whole)


def _is_rule(line: str) -> bool:
    return _RULE.fullmatch(line) is not None and any(c in "-=_─━═" for c in line)


def _cells(line: SourceText) -> list[SourceText]:
    r"""Return the cells of a line; \| is a bar inside a cell."""
    # Jira writes headers between two bars: ||a||alpha||.
    between = _DOUBLE if line.text.startswith("||") and line.text.endswith("||") else _SEPARATOR
    pieces = line.split(between)
    if len(pieces) > 1 and not pieces[0].text:
        pieces = pieces[1:]
    if len(pieces) > 1 and not pieces[-1].text:
        pieces = pieces[:-1]
    return [without_tags(piece) for piece in pieces]


FORMAT: Final = GridFormat(_matches, _parse)
