"""Tables in pasted texts: one reader for each format, in the order in which they are tried.

LaTeX is in ``latex.py``, matrices are in ``matrices.py``, tables of scripts in ``robots.py`` and
``named_columns.py``.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from html import unescape
from itertools import chain, islice, pairwise
from typing import Final, NamedTuple

from dh_grader.expressions.errors import Note
from dh_grader.pasting.around import UNIT, check_units
from dh_grader.pasting.program import text_around, unquoted
from dh_grader.pasting.source import (
    BARS,
    GRID_LIMITS,
    Grid,
    GridCell,
    GridError,
    GridFormat,
    SourceText,
    continues,
    grid,
    joined,
    once,
    outside,
    pairs,
    split_blanks,
    without_tags,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Rows whose values have names: ``Link 1: a = l1, alpha = 90°, d = 0, theta = q1``
#
# The values may also be below each other, as in YAML, or arguments: ``DH('a', l1, 'alpha', 0, …)``.


_COLUMNS: Final = ("a", "alpha", "d", "theta")
_LETTERS: Final = {"α": "alpha", "alfa": "alpha", "θ": "theta", "ϑ": "theta", "th": "theta"}
_NAMED: Final = regex(
    # What the name begins with comes first, because most characters of a text begin none.
    r"(?=['\"\\vaαtθϑd])(?<![\w\\^\"'.])(?<![\w^]\{)(?P<quote>['\"]?)\\?(?:var)?(?P<name>alpha|alfa|α|theta|th|θ|ϑ|a|d)"
    r"_?\{?(?P<number>[\d₀-₉]{0,2}|[ijᵢ])\}?(?P=quote)[ \t]{0,20}(?P<sign>[=:,])(?!=)"
)
# Marks that only style a text.
_STYLE: Final = regex(r"(?:\\[()]|\*\*|[`$])+")
# Signs of a list, of another name, or of an unclosed string.
_NOT_ONE: Final = regex(r"[=:'\"]|\A[\[{]|\A\Z")
# A word within a row that may be a value.
_LETTER: Final = regex(r"(?<!\w)\w{1,2}(?!\w)")
_STOP: Final = frozenset(",;\n\r|)]}")
_PADDING: Final = regex(r"[\s,;.:=→|()\[\]{}<>#*•·–—_-]+")
# Words before a name, or the label of a row: "Link 1", "2. Joint 2 (revolute)", "T1 = DH(".
_WORDS_BEFORE: Final = regex(
    r"(?:\d{1,2} (?=\D*\d))?(?:[^\W\d_]{1,20} ){0,3}(?:[^\W\d_]{0,20}(?P<number>\d{1,2}) )?"
    r"(?:[^\W\d_]{1,20} ){0,3}"
)
# A word between two values, and words before the next name: "0 and angle theta = q1".
_AND: Final = regex(
    r"(?:\A|\s)(?:and|und|y|et|with|mit|con|avec)(?:\s[^\W\d_]{3,20}){0,2}\s*\Z", re.IGNORECASE
)
# Words that change the parameter after them: "minus theta = q1".
_CHANGED: Final = regex(
    r"(?<!\w)(?:minus|plus|negative|half|twice|double|not|cos|sin|tan|menos|moins|nicht|halb|doppelt)"
    r"\s*\Z",
    re.IGNORECASE,
)
# Names before their values: (a, α, d, θ) = (l1, 0, 0, θ1).
_ONE: Final = r"\s{0,4}\\?(?:alpha|alfa|α|theta|th|θ|ϑ|a|d)_?\{?(?:[\d₀-₉]{0,2}|[ijᵢ])\}?\s{0,4}"
_GROUP: Final = regex(
    rf"[(\[](?P<names>{_ONE}(?:,{_ONE}){{3}})[)\]]\s{{0,4}}[=:]\s{{0,4}}(?=[(\[])"
)
_AFTER: Final = regex(r"[ \t]*(?:[,;.\r\n]|\Z)")
_COMMA: Final = regex(",")
_ORDINALS: Final = tuple(
    regex(rf"(?<!\w)(?:{words})\w{{0,4}}", re.IGNORECASE)
    for words in (
        "first|erst|primer|premi", "second|zweit|segund|deuxi", "third|dritt|tercer|troisi",
        "fourth|viert|cuart|quatri", "fifth|fünft|quint|cinqui", "sixth|sechst|sext|sixi",
    )
)  # fmt: skip
_SUBSCRIPTS: Final = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


class _Item(NamedTuple):
    """A value with a name, such as ``a_1 = 0.4``."""

    name: str
    number: str
    label: str
    value: SourceText


def _spread(source: SourceText) -> SourceText:
    """Return the text with each name before its value, if groups of names are before values."""
    text, pieces, start = source.text, [], 0
    ends = pairs(text)
    for group in _GROUP.finditer(text):
        opened, end = group.end(), ends.get(group.end(), 0)
        inside = source.cut(opened + 1, end - 1)
        names = source.cut(*group.span("names")).split(_COMMA)
        values = inside.cut_at(outside(inside.text, ","))
        is_whole = start <= opened < end and _AFTER.match(text, end)
        if not is_whole or len(values) != len(names):
            return source
        pieces.append(source.cut(start, group.start()))
        for name, value in zip(names, values, strict=True):
            pieces += [name, name.spelled("="), value, name.spelled(",")]
        start = end
    return joined([*pieces, source.cut(start, len(text))], source.at)


def _items(source: SourceText) -> list[_Item]:
    text = _STYLE.sub(lambda mark: " " * len(mark[0]), source.text)
    source = _spread(replace(source, text=text))
    text = source.text
    first = islice(_NAMED.finditer(text), len(_COLUMNS) * GRID_LIMITS.rows + 1)
    names = [name for name in first if name["sign"] != "," or name["quote"]]
    following = [*(name.start() for name in names), len(text)][1:]
    found: list[_Item] = []
    ends, at = pairs(text), 0
    for name, end in zip(names, following, strict=True):
        gap = _PADDING.sub(" ", f"{text[at : name.start()]} ").lstrip()
        gap = _AND.sub("", gap) if found else gap
        for i, ordinal in enumerate(_ORDINALS, 1):
            gap = ordinal.sub(str(i), gap)
        label = None if UNIT.search(gap) else _WORDS_BEFORE.fullmatch(gap)
        at = name.end()
        while at < end and text[at] not in _STOP:
            at = ends.get(at, at + 1)
        written = text[name.end() : at].rstrip(" \t.")
        if at == end < len(text):
            written = _AND.sub("", written)
        value = unquoted(source.cut(name.end(), name.end() + len(written)).strip())
        is_within = len(found) % len(_COLUMNS) > 0
        if _CHANGED.search(text, max(0, name.start() - 20), name.start()):
            return []
        if label is None or _NOT_ONE.search(value.text) or (is_within and _LETTER.search(gap)):
            return []
        letter = _LETTERS.get(name["name"], name["name"])
        number = name["number"].translate(_SUBSCRIPTS)
        found.append(_Item(letter, number, label["number"] or "", value))
    return [] if _PADDING.sub("", text[at:]) else found


def _named_values_rows(source: SourceText) -> list[list[SourceText]]:
    items, size, nothing = _items(source), len(_COLUMNS), source.cut(0, 0)
    rows, numbers = [[nothing.spelled("i"), *map(nothing.spelled, _COLUMNS)]], []
    for group in (items[i : i + size] for i in range(0, len(items), size)):
        named = {item.name: item for item in group}
        if sorted(named) != sorted(_COLUMNS) or any(item.label for item in group[1:]):
            return []
        numbers.append(_number([named[column].number for column in _COLUMNS], group[0].label))
        label = group[0].value.cut(0, 0).spelled(numbers[-1] or "")
        rows.append([label, *(named[column].value for column in _COLUMNS)])
    is_numbered = all(numbers) and len(set(numbers)) == len(numbers)
    return rows if numbers and (is_numbered or set(numbers) == {""}) else []


def _number(indices: list[str], label: str) -> str | None:
    # Return the number of a row, "" if it has none; None if its label and indices disagree.
    # In the modified convention, the indices of a and alpha are one less.
    if not all(map(str.isdigit, indices)):
        return None if any(map(str.isdigit, indices)) else label
    a, alpha, d, theta = map(int, indices)
    is_row = a == alpha and d == theta and d - a in {0, 1} and label in {"", str(d)}
    return str(d) if is_row else None


def _named_values_parse(source: SourceText) -> Grid:
    return grid("names", _named_values_rows(source), source.whole)


@once
def _named_values_matches(text: str) -> bool:
    return bool(_named_values_rows(SourceText.of(text)))


NAMED_VALUES: Final = GridFormat(_named_values_matches, _named_values_parse)


# --- Cells one below the other, as PDF readers and chats copy a table: each line is one cell


_HEADER: Final = regex(
    r"\$?\\?(?:(?P<a>a)|(?P<alpha>alpha|α)|(?P<d>d)|(?P<theta>theta|θ|ϑ))_?\{?[ijᵢ]?\}?\$?",
    re.IGNORECASE,
)
_COUNT: Final = 4
_ROW: Final = regex(r"(?:[^\W\d_]{1,20} ?)?\d{1,2}")


def _stacked_rows(source: SourceText) -> list[list[SourceText]]:
    lines = [line for line in map(SourceText.strip, source.lines()) if line.text]
    for width in (_COUNT, _COUNT + 1):
        headers = [_HEADER.fullmatch(line.text) for line in lines[width - _COUNT : width]]
        labels = [line.text for line in lines[width::width]] if width > _COUNT else []
        is_whole = len(lines) > width and len(lines) % width == 0
        if is_whole and len({name and name.lastgroup for name in headers} - {None}) == _COUNT:
            rows = [lines[i : i + width] for i in range(0, len(lines), width)]
            return rows if all(map(_ROW.fullmatch, labels)) else []
    return []


def _stacked_parse(source: SourceText) -> Grid:
    return grid("stacked", _stacked_rows(source), source.whole)


STACKED: Final = GridFormat(lambda text: bool(_stacked_rows(SourceText.of(text))), _stacked_parse)


# --- HTML: the source of a table on a web page
#
# There is a scanner of its own for it, because html.parser does not give each character's place in
# the pasted text, and does not take linear time for every text.


_START: Final = regex(r"<(?:table|tbody|thead|tr)(?![A-Za-z0-9-])", re.IGNORECASE)
_TAG: Final = regex(r"</?([A-Za-z][A-Za-z0-9-]{0,30})")
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


def _html_matches(text: str) -> bool:
    return _START.search(text) is not None


def _html_parse(source: SourceText) -> Grid:
    text = source.text
    table = _Table()
    i = 0
    while i < len(text):
        if text[i] == "<" and (tag := _TAG.match(text, i)):
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


HTML: Final = GridFormat(_html_matches, _html_parse)


# --- Cells between vertical bars: tables in Markdown and MediaWiki, and drawn tables


_BAR: Final = regex(rf"[{BARS}]")
_SEPARATOR: Final = regex(rf"(?<!\\)[{BARS}]")
_DOUBLE: Final = regex(r"\|\|")
_RULE: Final = regex(r"[\s|:+\-=_│┃║─━═┼╪╬┬┴├┤┌┐└┘╭╮╰╯┏┓┗┛┣┫┳┻╋╔╗╚╝╠╣╦╩╒╕╘╛╞╡╤╧╟╢┠┨┯┷]+")
# MediaWiki: separators of cells, attributes of a cell, and marks of style.
_WIKI_CELL: Final = regex(r"\|\||!!")
_WIKI_ATTRIBUTES: Final = regex(
    r"(?:\s{0,4}[a-z]{2,12}\s?=\s?(?:\"[^\"|]{0,80}\"|\w{1,20})){1,6}\s{0,4}\|"
)
_WIKI_STYLE: Final = regex(r"'{2,3}|</?(?:math|nowiki)>")


def _markdown_matches(text: str) -> bool:
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    barred = [line for line in lines if _BAR.search(line)]
    return len(barred) > 1 or sum(text.count(bar) for bar in BARS) > 2


def _markdown_parse(source: SourceText) -> Grid:
    rows: list[list[SourceText]] = []
    if source.text.lstrip().startswith("{|"):
        return grid("MediaWiki", _wiki_rows(source), source.whole)
    for line in map(SourceText.strip, source.lines()):
        if not line.text or _markdown_is_rule(line.text):
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


def _markdown_is_rule(line: str) -> bool:
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


MARKDOWN: Final = GridFormat(_markdown_matches, _markdown_parse)


# --- Split CSV, TSV and semicolon files into lines and cells, which may be quoted


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


# --- Cells separated by tabs, the clipboard format of spreadsheets and web pages


# A tab after a comma, or at the beginning of each line, is only layout.
_TAB: Final = regex(r"[^\s,;][^\S\n\t]*\t")


def _tsv_matches(text: str) -> bool:
    return _TAB.search(text) is not None


def _tsv_parse(source: SourceText) -> Grid:
    return grid("TSV", split_cells(source, "\t", brackets=False), source.whole)


TSV: Final = GridFormat(_tsv_matches, _tsv_parse)


# --- Cells separated by semicolons: CSV from a spreadsheet that uses decimal commas


def _semicolons_matches(text: str) -> bool:
    return ";" in text


def _semicolons_parse(source: SourceText) -> Grid:
    rows = split_cells(source, ";", brackets=False)
    filled = [row for row in rows if any(cell.text.strip() for cell in row)]
    if len(filled) == 1 and any(_holds_several(cell.text.strip()) for cell in filled[0]):
        raise GridError(
            "ambiguous_separators",
            say(
                "The semicolons here may separate rows or values. Put [ ] around a MATLAB "
                "matrix, or each row on a line of its own."
            ),
            source.whole,
        )
    return grid("CSV with semicolons", rows, source.whole)


def _holds_several(cell: str) -> bool:
    return any(True for _ in outside(cell, r",\s"))


SEMICOLONS: Final = GridFormat(_semicolons_matches, _semicolons_parse)


# --- Cells separated by commas. A comma in brackets, as in atan2(y, x), is part of its cell


# The label of a row with a colon or bracket after it: "1: l1, 0", "Row 1: l1, 0", "a: l1, l2".
_CSV_LABEL: Final = regex(
    r"(?:[ij]\s?=\s?)?((?:[^\W\d_]{3,20}[ .]?|[JjLl])?\d{1,2}|(?:alpha|theta|[adαθ])(?=\s?:))"
    r"\s?[:)]\s{0,9}(?=\S)"
)


def _csv_matches(text: str) -> bool:
    return any(True for _ in outside(text, ","))


def _csv_parse(source: SourceText) -> Grid:
    rows = split_cells(source, ",", brackets=True)
    rows = [[row[0].strip(), *row[1:]] for row in rows if len(row) > 1 or row[0].text.strip()]
    filled = [row for row in rows if any(cell.text.strip() for cell in row)]
    labels = [_CSV_LABEL.match(row[0].text) for row in filled]
    if all(labels) and len(set(map(len, filled))) == 1:
        rows = [
            [row[0].cut(*label.span(1)), row[0].cut(label.end(), len(row[0].text)), *row[1:]]
            for row, label in zip(filled, labels, strict=True)
            if label
        ]
    return grid("CSV", rows, source.whole)


CSV: Final = GridFormat(_csv_matches, _csv_parse)


# --- Columns separated by blanks; all lines have equally many values


_GAP: Final = regex(r"[^\S\r\n]{2,}")
_UNIT: Final = regex(
    r"[(\[](?:deg|rad|grad|grados|degrés|°|[mc]?m|度|弧度|米|毫米)[)\]]", re.IGNORECASE
)
_DASHES: Final = frozenset("-=_─━═")


def _columns_matches(text: str) -> bool:
    lines = [line.strip() for line in text.strip().splitlines()]
    lines = [line for line in lines if line and not _columns_is_rule(line)]
    if len(lines) > 3:
        # pandas prints the name of the index alone on the second line.
        del lines[1]
    return len(lines) > 1 and all(any(c.isspace() for c in line) for line in lines)


def _columns_parse(source: SourceText) -> Grid:
    lines = [line.strip() for line in source.lines()]
    lines = [line for line in lines if line.text and not _columns_is_rule(line.text)]
    wide = [_at_gaps(line) for line in lines]
    narrow = [list(split_blanks(line).elements) for line in lines]
    narrow[0] = _with_units(narrow[0])
    wide, narrow = with_row_numbers(wide), with_row_numbers(narrow)
    readings = [rows for rows in (wide, narrow) if _is_table(rows)]
    if not readings:
        raise _uneven(lines, narrow)
    if len(readings) == 2 and list(map(len, wide)) != list(map(len, narrow)):
        raise GridError(
            "ambiguous_columns",
            say(
                "Each line may have {few} or {many} values: a space may separate two values or "
                "stand inside one. Write commas between the values.",
                few=len(wide[0]),
                many=len(narrow[0]),
            ),
            lines[0].whole,
        )
    first = readings[0][0]
    message = say(
        "Spaces were read as separators: each line has {number} values.", number=len(first)
    )
    note = Note("blank_columns", message, first[0].whole)
    return grid("columns", readings[0], source.whole, [note])


def _with_units(words: list[SourceText]) -> list[SourceText]:
    """Return the words of a header, in which ``a (m)`` is one word."""
    found: list[SourceText] = []
    for word in words:
        if found and _UNIT.fullmatch(word.text):
            word = joined([found.pop(), word.spelled(" "), word], word.at)
        found.append(word)
    return found


def _columns_is_rule(line: str) -> bool:
    return len(line) > 2 and set(line) - {" "} <= _DASHES


def _at_gaps(line: SourceText) -> list[SourceText]:
    pieces = line.split(_GAP)
    halves = any(continues(left.text, right.text) for left, right in pairwise(pieces))
    return [] if halves else pieces


def _is_table(rows: list[list[SourceText]]) -> bool:
    return len({len(row) for row in rows}) == 1 and len(rows[0]) > 1


def _uneven(lines: list[SourceText], rows: list[list[SourceText]]) -> GridError:
    at = next((i for i, row in enumerate(rows) if len(row) != len(rows[0])), 0)
    message = say("Each line seems to have one value. Write commas between the values.")
    if at:
        message = say(
            "Lines {before} and {line} seem to have different numbers of values: {first} and "
            "{other}. Write commas between the values.",
            before=lines[0].line_number,
            line=lines[at].line_number,
            first=len(rows[0]),
            other=len(rows[at]),
        )
    return GridError("ambiguous_columns", message, lines[at].whole)


COLUMNS: Final = GridFormat(_columns_matches, _columns_parse)


# --- Read data frames as pandas, R, Julia and MATLAB print them


# The first line: "# A tibble: 3 × 4", "3×4 DataFrame", "3×4 table", "ans = 3×4", "shape: (3, 4)".
_SIZE: Final = regex(
    r"^[ \t]*(?:# A tibble: \d{1,3} [×x] \d{1,3}|\d{1,3} ?[×x] ?\d{1,3} (?:DataFrame|table"
    r"|Matrix\{\w{1,20}\}:)|\w{1,20} = \d{1,3} ?[×x] ?\d{1,3}|shape: \(\d{1,3}, \d{1,3}\))"
    r"[ \t]*\r?$",
    re.MULTILINE,
)
# The line of types: <dbl> <chr>, or │ String Float64.
_TYPES: Final = regex(
    r"[ \t]*(?:<\w{1,9}>[ \t]*)+"
    r"|[ \t]*│[ \t]*(?:(?:str|f64|f32|i64|i32|String|Float64|Int64|Any|Sym|Num)\d{0,2}\??"
    r"[ \t…┆│]*)+"
)
_LINES: Final = regex(r"[\s┌┬┐├┼┤└┴┘╞╪╡│┆─═-]*")
_QUOTES: Final = regex(r"[\"│┆{}]")
# R numbers the columns and rows of a matrix: [,1] [,2], and [1,] before each row.
_COLUMNS_OF_R: Final = regex(r"\s*(?:\[,\d{1,2}\]\s*)+")
# The number of a row, alone or after a word: 1, Link 1, joint_1, J1; but not theta1.
_WORD: Final = r"(?!theta|alpha)(?:[^\W\d_]{3,20}|[Jj]|[\u4e00-\u9fff]{2})"
_INDEX: Final = regex(rf"(?P<name>(?:{_WORD}[ _.]?)?)(?P<number>\d{{1,2}})", re.IGNORECASE)
_DATA_FRAME_LABEL: Final = regex(rf"(?P<word>{_WORD}) (?P<number>\d{{1,2}})", re.IGNORECASE)
_ROW_OF_R: Final = regex(r"[ \t]*\[\d{1,2},\]")


def without_frame(source: SourceText) -> SourceText:
    """Return a printed data frame as columns separated by blanks; any other text unchanged."""
    first, *lines = [line for line in source.lines() if line.text.strip()] or [source]
    if _COLUMNS_OF_R.fullmatch(first.text):
        rows = [
            line.cut(label.end(), len(line.text))
            for line in lines
            if (label := _ROW_OF_R.match(line.text))
        ]
        return _joined_lines(rows, source) if len(rows) == len(lines) else source
    size = _SIZE.search(source.text)
    if size is None or source.text[: size.start()].strip(" \t\r\n=abcdefghijklmnopqrstuvwxyz"):
        return source
    pieces = [
        replace(line, text=_QUOTES.sub(" ", line.text))
        for line in source.cut(size.end(), len(source.text)).lines()
        if not _TYPES.fullmatch(line.text.rstrip()) and not _LINES.fullmatch(line.text)
    ]
    return _joined_lines(pieces, source)


def _joined_lines(lines: list[SourceText], source: SourceText) -> SourceText:
    ended = [piece for line in lines for piece in (line, line.cut(0, 0).spelled("\n"))]
    return joined(ended, source.at)


def with_row_numbers(rows: list[list[SourceText]]) -> list[list[SourceText]]:
    """Add the header above the row numbers, which pandas and R do not print."""
    # The new header is empty, or the name of the index if pandas prints this name in the second
    # line.
    rows = _with_whole_labels(rows)
    head, *body = rows
    named = len(body) > 1 and len(body[0]) == 1 and len(head) > 1
    label = body.pop(0)[0] if named else head[0].cut(0, 0)
    if not body or any(len(row) != len(head) + 1 for row in body):
        return rows
    if any(any(map(str.isdigit, cell.text)) for cell in [label, *head]):
        return rows
    numbers = [_INDEX.fullmatch(row[0].text) for row in body]
    names = {number["name"] for number in numbers if number}
    counted = [number["number"] if number else "" for number in numbers]
    if len(names) > 1 or counted not in (
        [str(i + first) for i in range(len(body))] for first in (0, 1)
    ):
        return rows
    return [[label, *head], *body]


def _with_whole_labels(rows: list[list[SourceText]]) -> list[list[SourceText]]:
    # Return the rows with each label, such as Link 1, in one cell.
    # All rows below the headers must have a label, otherwise the rows do not change. A line with
    # the name of the index may follow the headers.
    for start in range(min(3, len(rows))):
        body = rows[start:]
        if min(map(len, body)) > 2 and _are_labelled(body):
            return [*rows[:start], *map(_with_whole_label, body)]
    return rows


def _are_labelled(rows: list[list[SourceText]]) -> bool:
    found = [_DATA_FRAME_LABEL.fullmatch(f"{word.text} {number.text}") for word, number, *_ in rows]
    numbers = [int(each["number"]) for each in found if each]
    words = {each["word"] for each in found if each}
    return len(words) == 1 and numbers in [[*range(i, len(rows) + i)] for i in (0, 1)]


def _with_whole_label(row: list[SourceText]) -> list[SourceText]:
    word, number, *cells = row
    return [joined([word, number.cut(0, 0).spelled(" "), number], word.at), *cells]


# --- Decimal commas in a grid whose cells are separated by other signs: ``0,1625;90°;0,4``
#
# Spreadsheets of most European countries write numbers so. A comma is never guessed to be a decimal
# comma: each comma after a digit must be one, and at least one number must have no other meaning.


_NUMBER: Final = regex(r"(?<![\w.,])\d{1,15},\d{1,15}(?![\w.,]*[.,]\d)", re.ASCII)
# A number whose comma may stand between thousands: 1,000 or 12,500.
_THOUSANDS: Final = regex(r"[1-9]\d{0,2},\d{3}", re.ASCII)
# A point that may stand between thousands in the same language: 1.000 or 12.500,5.
_POINT: Final = regex(r"(?<![\d.])[1-9]\d{0,2}\.\d{3}(?!\d)", re.ASCII)
# A number with a sign between thousands and a decimal comma: 1.000,5. The reader of its cell names
# the sign.
_GROUPED: Final = regex(
    r"(?<![\w.,])[1-9]\d{0,2}(?:[.'’ \u00a0\u202f]\d{3})+,\d{1,15}(?![\w.,]*[.,]\d)", re.ASCII
)
# One line between semicolons may be several rows of a matrix.
_FEWEST: Final = 2


def with_decimal_points(grid: Grid) -> Grid:
    """Return the grid with points for its decimal commas, and a note; unchanged if unsure.

    Raises GridError if a point in another number may separate thousands.
    """
    if len(grid.rows) < _FEWEST or min(map(len, grid.rows)) < _FEWEST:
        return grid
    cells = [
        cell
        for cell in chain.from_iterable(grid.rows)
        if "," in cell.text and not _GROUPED.search(cell.text)
    ]
    found = [_numbers(cell.text) for cell in cells]
    numbers = [number for each in found for number in (each or {}).values()]
    is_sure = all(each is not None for each in found) and any(
        not _THOUSANDS.fullmatch(number) for number in numbers
    )
    if not is_sure:
        return grid
    for cell in chain.from_iterable(grid.rows):
        if (point := _POINT.search(cell.text)) and not _GROUPED.search(cell.text):
            raise _in_thousands(cell, point)
    message = say(
        "`{typed}` is read as {number}: the comma is a decimal comma.",
        typed=numbers[0],
        number=numbers[0].replace(",", "."),
    )
    first = next(cell for cell, each in zip(cells, found, strict=True) if each)
    rows = tuple(tuple(map(_with_points, row)) for row in grid.rows)
    note = Note("decimal_comma_read", message, first.whole)
    return replace(grid, rows=rows, notes=(*grid.notes, note))


def _in_thousands(cell: GridCell, number: re.Match[str]) -> GridError:
    message = say(
        "The point in `{typed}` may separate thousands, because other numbers here have a decimal "
        "comma. Write {thousands} or {number}.",
        typed=number[0],
        thousands=number[0].replace(".", ""),
        number=number[0].replace(".", ","),
    )
    return GridError("decimal_comma", message, cell.span(*number.span()))


def _numbers(text: str) -> Mapping[int, str] | None:
    # The numbers with a decimal comma outside brackets, by the place of the comma. None if another
    # comma follows a digit.
    found = {number.start() + number[0].index(","): number[0] for number in _NUMBER.finditer(text)}
    after_digit = [i for i in outside(text, ",") if text[i - 1 : i].isdigit()]
    if any(i not in found for i in after_digit):
        return None
    return {i: found[i] for i in after_digit}


def _with_points(cell: GridCell) -> GridCell:
    if "," not in cell.text or _GROUPED.search(cell.text):
        return cell
    places = _numbers(cell.text) or {}
    letters = ["." if i in places else letter for i, letter in enumerate(cell.text)]
    return replace(cell, text="".join(letters))
