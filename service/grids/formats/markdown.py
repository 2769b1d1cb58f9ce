"""Cells between vertical bars: tables in Markdown and MediaWiki, and drawn tables."""

from typing import Final

from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.markup import without_tags
from service.grids.cutting.source_text import SourceText, joined
from service.grids.formats.html import refuse_span
from service.grids.scripts.program_text import text_around
from service.grids.scripts.titles import check_units
from service.regex import regex
from service.translations import say

_BARS: Final = "|│┃║"
_BAR: Final = regex(rf"[{_BARS}]")
_SEPARATOR: Final = regex(rf"(?<!\\)[{_BARS}]")
_DOUBLE: Final = regex(r"\|\|")
_RULE: Final = regex(r"[\s|:+\-=_│┃║─━═┼╪╬┬┴├┤┌┐└┘╭╮╰╯┏┓┗┛┣┫┳┻╋╔╗╚╝╠╣╦╩╒╕╘╛╞╡╤╧╟╢┠┨┯┷]+")


# MediaWiki: separators of cells, attributes of a cell, and marks of style.
_WIKI_CELL: Final = regex(r"\|\||!!")
_WIKI_ATTRIBUTES: Final = regex(
    r"(?:\s{0,4}[a-z]{2,12}\s?=\s?(?:\"[^\"|]{0,80}\"|\w{1,20})){1,6}\s{0,4}\|"
)
_WIKI_STYLE: Final = regex(r"'{2,3}|</?(?:math|nowiki)>")


def _matches(text: str) -> bool:
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    barred = [line for line in lines if _BAR.search(line)]
    return len(barred) > 1 or sum(text.count(bar) for bar in _BARS) > 2


def _parse(source: SourceText) -> Grid:
    rows: list[list[SourceText]] = []
    if source.text.lstrip().startswith("{|"):
        return grid("MediaWiki", _wiki_rows(source), source.whole)
    for line in map(SourceText.strip, source.lines()):
        if not line.text or _is_rule(line.text):
            continue
        cells = _cells(line)
        if len(cells) == 1 and not _SEPARATOR.search(line.text):
            message = say(
                "Line {line} is in the table, but has no |. Delete it, or paste the table alone.",
                line=line.line_number,
            )
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


def _wiki_rows(source: SourceText) -> list[list[SourceText]]:
    rows: list[list[SourceText]] = [[]]
    _, *lines = [line for line in map(SourceText.strip, source.lines()) if line.text]
    for line in lines:
        if line.text.startswith("|-"):
            rows.append([])
        elif line.text.startswith("|+"):
            check_units(line)
        elif line.text[0] in "|!" and line.text != "|}":
            pieces = line.cut(1, len(line.text)).split(_WIKI_CELL)
            rows[-1] += [_wiki_cell(piece) for piece in pieces]
        elif line is not lines[-1] or line.text != "|}":
            raise text_around(line)
    return rows


def _wiki_cell(piece: SourceText) -> SourceText:
    if attributes := _WIKI_ATTRIBUTES.match(piece.text):
        refuse_span(piece, 0, attributes.end())
        piece = piece.cut(attributes.end(), len(piece.text))
    return without_tags(joined(piece.split(_WIKI_STYLE), piece.at))


FORMAT: Final = GridFormat(_matches, _parse)
