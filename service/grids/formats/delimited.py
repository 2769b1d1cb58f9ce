"""Split CSV, TSV and semicolon files into lines and cells, which may be quoted."""

import re
from collections.abc import Mapping

from service.grids.cutting.grid import GridError
from service.grids.cutting.pairs import pairs
from service.grids.cutting.source_text import SourceText, joined
from service.translations import say

_LINE_ENDS = "\r\n\x85\u2028\u2029"


def split_cells(source: SourceText, separator: str, *, brackets: bool) -> list[list[SourceText]]:
    """Return the cells of each line; a cell may be in quotation marks, as in spreadsheets.

    With ``brackets``, a separator in brackets is part of its cell. Raises GridError for a quotation
    mark without a partner.
    """
    # GridError also if more text follows the closing quotation mark in the cell.
    text = source.text
    ends = pairs(text) if brackets else {}
    plain = re.compile(
        f"[^{re.escape(separator + _LINE_ENDS + ''.join({text[i] for i in ends}))}]*"
    )
    rows: list[list[SourceText]] = [[]]
    i = 0
    while True:
        cell, i = _cell(source, i, separator + _LINE_ENDS, ends, plain)
        rows[-1].append(cell)
        if i >= len(text):
            return rows
        if text[i] != separator:
            rows.append([])
        i += 1


def _cell(
    source: SourceText, start: int, stops: str, ends: Mapping[int, int], plain: re.Pattern[str]
) -> tuple[SourceText, int]:
    text = source.text
    i = start
    while i < len(text) and text[i].isspace() and text[i] not in stops:
        i += 1
    if text[i : i + 1] == '"':
        return _quoted(source, i, stops)
    while (i := _end(plain, text, i)) < len(text) and text[i] not in stops:
        i = ends.get(i, i + 1)
    return source.cut(start, i), i


def _end(plain: re.Pattern[str], text: str, start: int) -> int:
    found = plain.match(text, start)
    return found.end() if found else start


def _quoted(source: SourceText, start: int, stops: str) -> tuple[SourceText, int]:
    text = source.text
    pieces: list[SourceText] = []
    i = start + 1
    while True:
        close = text.find('"', i)
        if close < 0:
            message = say("This cell has no quotation mark at its end. Add it, or delete this one.")
            raise GridError("unclosed_quote", message, source.span(start, start + 1))
        if text[close + 1 : close + 2] != '"':
            break
        pieces.append(source.cut(i, close + 1))
        i = close + 2
    pieces.append(source.cut(i, close))
    end = close + 1
    while end < len(text) and text[end].isspace() and text[end] not in stops:
        end += 1
    if end < len(text) and text[end] not in stops:
        message = say(
            'The cell must end after this quotation mark. Delete the marks, or write "" inside.'
        )
        raise GridError("stray_quote", message, source.span(close, close + 1))
    return joined(pieces, source.span(start + 1)[0]), end
