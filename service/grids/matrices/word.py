r"""Matrices as Word writes them in one line: ``T=[■(a&b@c&d)]``, also ``■8(…)``, ``\matrix(…)``.

The sign @ separates rows and & separates values.
"""

# Source: M. Sargent, UnicodeMath, Unicode Technical Note 28.

import re
from typing import Final

from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.pairs import CLOSES
from service.grids.cutting.source_text import SourceText
from service.grids.scripts.program_text import TAIL, text_around
from service.regex import regex
from service.translations import say

# ⓢ and ⒨ are matrices in [ ] and in ( ).
_MATRIX: Final = regex(r"(?:■8?|[ⓢ⒨]|\\[bp]?matrix)[ \t]{0,4}\(")
# An equation array: a column, unless & marks where its lines are aligned.
_COLUMN: Final = regex(r"█[ \t]{0,4}\(")
_OPENS: Final = {**CLOSES, "〖": "〗"}
_SIGN: Final = regex(r"[][(){}〖〗&@]")
_NUMBER_OF_EQUATION: Final = regex(r"#[ \t]?\(?\d{0,4}(?:\.\d{1,4})?\)?")


def _matches(text: str) -> bool:
    return _sign(text).search(text) is not None


def _sign(text: str) -> re.Pattern[str]:
    return _COLUMN if "█" in text and "&" not in text and "■" not in text else _MATRIX


def _parse(source: SourceText) -> Grid:
    sign = _sign(source.text)
    begin = sign.search(source.text)
    assert begin is not None
    again = sign.search(source.text, begin.end())
    if again is not None:
        raise text_around(source.cut(again.start(), len(source.text)))
    rows, end = _rows(source, begin.end())
    _check_around(source.cut(0, begin.start()), source.cut(end, len(source.text)))
    return grid("Word", rows, source.whole)


def _rows(source: SourceText, start: int) -> tuple[list[list[SourceText]], int]:
    rows: list[list[SourceText]] = [[]]
    opened: list[str] = []
    for sign in _SIGN.finditer(source.text, start):
        letter, at = sign[0], sign.start()
        if letter in _OPENS:
            opened.append(_OPENS[letter])
        elif letter not in "&@" and opened:
            if opened.pop() != letter:
                break
        elif not opened:
            rows[-1].append(source.cut(start, at))
            start = sign.end()
            if letter == ")":
                return rows, start
            if letter == "@":
                rows.append([])
            elif letter != "&":
                break
    message = say(
        "The brackets of this matrix do not belong together. Copy the whole equation again."
    )
    raise GridError("unbalanced_bracket", message, source.whole)


def _check_around(front: SourceText, rest: SourceText) -> None:
    front, rest = front.strip(), rest.strip()
    closer = CLOSES.get(front.text[-1:], "")
    if closer and rest.text.startswith(closer):
        front, rest = front.cut(0, len(front.text) - 1).strip(), rest.cut(1, len(rest.text))
    rest = rest.strip(TAIL)
    if front.text and not front.text.endswith("="):
        raise text_around(front.cut(front.text.rfind("=") + 1, len(front.text)))
    if rest.text and not _NUMBER_OF_EQUATION.fullmatch(rest.text):
        raise text_around(rest)


FORMAT: Final = GridFormat(_matches, _parse)
