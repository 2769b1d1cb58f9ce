"""Read data frames as pandas, R, Julia and MATLAB print them."""

import re
from dataclasses import replace
from typing import Final

from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex

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
_LABEL: Final = regex(rf"(?P<word>{_WORD}) (?P<number>\d{{1,2}})", re.IGNORECASE)
_ROW_OF_R: Final = regex(r"[ \t]*\[\d{1,2},\]")


def without_frame(source: SourceText) -> SourceText:
    """Return a printed data frame as columns separated by blanks; any other text unchanged."""
    first, *lines = [line for line in source.lines() if line.text.strip()] or [source]
    if _COLUMNS_OF_R.fullmatch(first.text):
        rows = [line.cut(end.end(), len(line.text)) for line in lines if (end := _row_of_r(line))]
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


def _row_of_r(line: SourceText) -> re.Match[str] | None:
    return _ROW_OF_R.match(line.text)


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
    found = [_LABEL.fullmatch(f"{word.text} {number.text}") for word, number, *_ in rows]
    numbers = [int(each["number"]) for each in found if each]
    words = {each["word"] for each in found if each}
    return len(words) == 1 and numbers in [[*range(i, len(rows) + i)] for i in (0, 1)]


def _with_whole_label(row: list[SourceText]) -> list[SourceText]:
    word, number, *cells = row
    return [joined([word, number.cut(0, 0).spelled(" "), number], word.at), *cells]
