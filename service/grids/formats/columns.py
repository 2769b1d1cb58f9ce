"""Columns separated by blanks; all lines have equally many values."""

import itertools
import re
from typing import Final

from service.expressions.errors import Note
from service.grids.cutting.blanks import continues, split_blanks
from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.source_text import SourceText, joined
from service.grids.formats.data_frame import with_row_numbers
from service.regex import regex
from service.translations import say

_GAP: Final = regex(r"[^\S\r\n]{2,}")
_UNIT: Final = regex(
    r"[(\[](?:deg|rad|grad|grados|degrés|°|[mc]?m|度|弧度|米|毫米)[)\]]", re.IGNORECASE
)
_DASHES: Final = frozenset("-=_─━═")


def _matches(text: str) -> bool:
    lines = [line.strip() for line in text.strip().splitlines()]
    lines = [line for line in lines if line and not _is_rule(line)]
    if len(lines) > 3:
        # pandas prints the name of the index alone on the second line.
        del lines[1]
    return len(lines) > 1 and all(any(c.isspace() for c in line) for line in lines)


def _parse(source: SourceText) -> Grid:
    lines = [line.strip() for line in source.lines()]
    lines = [line for line in lines if line.text and not _is_rule(line.text)]
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


def _is_rule(line: str) -> bool:
    return len(line) > 2 and set(line) - {" "} <= _DASHES


def _at_gaps(line: SourceText) -> list[SourceText]:
    pieces = line.split(_GAP)
    halves = any(continues(left.text, right.text) for left, right in itertools.pairwise(pieces))
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


FORMAT: Final = GridFormat(_matches, _parse)
