"""Split a row into elements at blanks, by MATLAB's rule for square brackets.

A sign with a blank before it but not after it begins a new element: ``[c1 -s1]`` has two elements,
``[c1 - s1]`` has one.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import Final

from service.expressions.vocabulary.functions import SPELLINGS
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.pairs import outside
from service.grids.cutting.source_text import SourceText
from service.regex import regex

_SIGNS: Final = "+-−–"
_BINARY: Final = "*/^×·⋅∙∗•÷="
_UNIT: Final = regex(r"(?:deg|degrees?|rad|radians?)(?![A-Za-z0-9])|[°º˚]", re.IGNORECASE)
# A function's name alone is not an element, so the blank after it separates nothing.
_FUNCTION: Final = regex(rf"(?<![A-Za-z])(?:{'|'.join(SPELLINGS)})(?:(?:\^|\*\*)\d+)?$")
# The number of characters at the end of an element that decide whether it continues.
_END: Final = 16
# The rest of a longer row stays in one piece.
_MAX_ELEMENTS: Final = 2 * GRID_LIMITS.columns


@dataclass(frozen=True, slots=True)
class BlankSeparated:
    """The elements of a row.

    ``signs`` are the words, such as -s1, that are separate elements only because of their sign.
    """

    elements: tuple[SourceText, ...]
    signs: tuple[SourceText, ...]


def split_blanks(row: SourceText) -> BlankSeparated:
    """Split a row into elements by MATLAB's rule for blanks; brackets stay in one piece."""
    words = _words(row.text)
    start, end = next(words, (0, 0))
    if not end:
        return BlankSeparated((), ())
    elements: list[SourceText] = []
    signs: list[SourceText] = []
    for next_start, next_end in words:
        if len(elements) == _MAX_ELEMENTS:
            end = len(row.text.rstrip())
            break
        left, right = row.text[max(start, end - _END) : end], row.text[next_start:next_end]
        if not continues(left, right):
            elements.append(row.cut(start, end))
            if right[0] in _SIGNS:
                signs.append(row.cut(next_start, next_end))
            start = next_start
        end = next_end
    elements.append(row.cut(start, end))
    return BlankSeparated(tuple(elements), tuple(signs))


def continues(left: str, right: str) -> bool:
    """True if ``left`` and ``right``, with a blank between them, are parts of one element."""
    if left[-1] == "*" and left[-2:-1].strip(" \t\r\n.*"):
        # ``d3* 0`` is a joint variable marked by a star, and a zero; it is not a product.
        return False
    if left[-1] in _SIGNS or left[-1] in _BINARY:
        return True
    if right[0] in _SIGNS:
        return len(right) == 1
    if right[0] in _BINARY or right[:2] in {".*", "./", ".^"} or _UNIT.match(right):
        return True
    return _FUNCTION.search(left) is not None


def _words(text: str) -> Iterator[tuple[int, int]]:
    for a, b in pairwise(chain([-1], outside(text, r"\s"), [len(text)])):
        if a + 1 < b:
            yield a + 1, b
