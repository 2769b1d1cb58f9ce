"""HTML: the source of a table on a web page."""

# This file has its own scanner, because html.parser does not give each character's place in the
# pasted text, and does not take linear time for every text.

import re
from dataclasses import dataclass, field
from html import unescape
from typing import Final

from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex
from service.translations import say

_START: Final = regex(r"<(?:table|tbody|thead|tr)(?![A-Za-z0-9-])", re.IGNORECASE)
_NAME: Final = regex(r"</?([A-Za-z][A-Za-z0-9-]{0,30})")
_ENTITY: Final = regex(r"&(?:#[0-9]{1,7}|#[xX][0-9A-Fa-f]{1,6}|[A-Za-z][A-Za-z0-9]{1,31});")
_SPAN: Final = regex(r"(?:col|row)span\s{0,4}=\s{0,4}[\"']?\s{0,4}([0-9]{1,4})", re.IGNORECASE)
_STYLING: Final = frozenset({
    "a", "abbr", "b", "bdi", "big", "code", "em", "font", "i", "kbd", "mark", "nobr", "p", "small",
    "span", "strong", "tt", "u", "var", "div", "wbr",
})  # fmt: skip
_LAYOUT: Final = frozenset({
    "html", "body", "table", "thead", "tbody", "tfoot", "caption", "colgroup", "col", "tr", "td",
    "th",
})  # fmt: skip
_SKIPPED: Final = frozenset({"style", "script", "caption"})
_CELLS: Final = frozenset({"tr", "td", "th"})
_STRUCK_OUT: Final = regex("line-through", re.IGNORECASE)
_MARK: Final = regex("<(?=[/!A-Za-z])|&")
_DEGREE_SIGNS: Final = frozenset({"o", "O", "0", "°", "º", "∘", "˚"})


@dataclass
class _Table:
    rows: list[list[SourceText]] = field(default_factory=list)
    pieces: list[SourceText] = field(default_factory=list)
    cell_at: int | None = None
    tables: int = 0
    depth: int = 0
    raised: str = ""
    raised_from: int = 0


def _matches(text: str) -> bool:
    return _START.search(text) is not None


def _parse(source: SourceText) -> Grid:
    text = source.text
    table = _Table()
    i = 0
    while i < len(text):
        if text[i] == "<" and (tag := _NAME.match(text, i)):
            end = _after_tag(source, i)
            if table.cell_at is not None or tag[1].lower() in _CELLS:
                _refuse_struck_out(source, i, end)
            i = _tag(source, table, tag, end)
        elif text.startswith("<!", i):
            close = text.find("-->" if text.startswith("<!--", i) else ">", i)
            i = len(text) if close < 0 else text.index(">", close) + 1
        else:
            i = _text(source, table, i)
    _end_cell(source, table)
    return grid("HTML", table.rows, source.whole)


def _after_tag(source: SourceText, start: int) -> int:
    """Return the position after the tag's >. A > in a quoted attribute does not count."""
    text = source.text
    i = start
    while i < len(text):
        if text[i] == ">":
            return i + 1
        if text[i] in "\"'":
            i = text.find(text[i], i + 1)
            if i < 0:
                break
        i += 1
    message = say("This tag does not end; > is missing.")
    raise GridError("unclosed_tag", message, source.span(start, start + 1))


def _tag(source: SourceText, table: _Table, tag: re.Match[str], end: int) -> int:
    name, start = tag[1].lower(), tag.start()
    closes = source.text[start + 1] == "/"
    place = source.span(start, end)
    if name in _SKIPPED and not closes:
        return _after_element(source, name, end)
    if name == "table":
        _table_tag(table, place, closes=closes)
    if name in _LAYOUT:
        _end_cell(source, table)
    if name == "tr" and not closes:
        table.rows.append([])
    elif name in {"td", "th"} and not closes:
        refuse_span(source, start, end)
        table.cell_at = end
        if not table.rows:
            table.rows.append([])
    elif name in {"sup", "sub"}:
        _raise_or_lower(source, table, "" if closes else name, start, end)
    elif name == "br":
        table.pieces.append(source.cut(start, start + 1).spelled(" "))
    elif name not in _STYLING and name not in _LAYOUT and table.cell_at is not None:
        message = say("<{tag}> cannot be read in a cell. Type its content as plain text.", tag=name)
        raise GridError("unread_tag", message, place)
    return end


def _after_element(source: SourceText, name: str, start: int) -> int:
    close = re.compile(rf"</{name}\s{{0,8}}>", re.IGNORECASE).search(source.text, start)
    return close.end() if close else len(source.text)


def _table_tag(table: _Table, place: tuple[int, int], *, closes: bool) -> None:
    if closes:
        table.depth -= 1
        return
    table.depth += 1
    table.tables += 1
    if table.depth > 1:
        message = say("One table inside another cannot be read. Write all entries in one.")
        raise GridError("nested_table", message, place)
    if table.tables > 1:
        raise GridError("two_tables", say("There are two tables here; paste one of them."), place)


def refuse_span(source: SourceText, start: int, end: int) -> None:
    """Raise GridError if the attributes in [start, end) make a cell span others."""
    for span in _SPAN.finditer(source.text, start, end):
        if span[1] != "1":
            raise GridError(
                "spanning_cell",
                say(
                    "A cell over several columns or rows cannot be read; write each value in a "
                    "cell of its own."
                ),
                source.span(*span.span()),
            )


def _refuse_struck_out(source: SourceText, start: int, end: int) -> None:
    if found := _STRUCK_OUT.search(source.text, start, end):
        raise struck_out(source.span(*found.span()))


def struck_out(place: tuple[int, int]) -> GridError:
    """Return the error that struck-out text is not read: nobody knows whether it counts."""
    return GridError("unread_tag", say("Struck-out text cannot be read. Delete it."), place)


def _raise_or_lower(source: SourceText, table: _Table, name: str, start: int, end: int) -> None:
    if name:
        table.raised, table.raised_from = name, len(table.pieces)
        return
    if not table.raised:
        return
    inner = joined(table.pieces[table.raised_from :], end)
    del table.pieces[table.raised_from :]
    here = source.cut(start, end)
    content = inner.text.strip()
    if table.raised == "sub":
        around = ("_{", "}")
    elif content in _DEGREE_SIGNS:
        inner, around = inner.spelled("°"), ("", "")
    elif content == "*":
        around = ("", "")
    else:
        around = ("^(", ")")
    table.pieces += [inner.cut(0, 0).spelled(around[0]), inner, here.spelled(around[1])]
    table.raised = ""


def _text(source: SourceText, table: _Table, start: int) -> int:
    text = source.text
    if entity := _ENTITY.match(text, start):
        end = entity.end()
        piece = source.cut(start, end).spelled(unescape(entity[0]))
    else:
        mark = _MARK.search(text, start + 1)
        end = mark.start() if mark else len(text)
        piece = source.cut(start, end)
    if table.cell_at is not None:
        table.pieces.append(piece)
    return end


def _end_cell(source: SourceText, table: _Table) -> None:
    if table.cell_at is not None:
        table.rows[-1].append(joined(table.pieces, source.span(table.cell_at)[0]))
    table.pieces, table.cell_at, table.raised = [], None, ""


FORMAT: Final = GridFormat(_matches, _parse)
