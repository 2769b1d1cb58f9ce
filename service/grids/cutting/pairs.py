"""Find pairs of brackets and quotes. A separator inside a pair does not split a cell."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Final

from service.grids.cutting.grid import GridError, too_many_cells
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.once import once
from service.grids.cutting.source_text import SourceText
from service.regex import regex
from service.translations import say

Ends = Mapping[int, int]

CLOSES: Final = {"[": "]", "(": ")", "{": "}"}
_OPENS: Final = {closer: opener for opener, closer in CLOSES.items()}
_STRINGS: Final = {quote: regex(rf"{quote}(?:[^\\{quote}\n]|\\.)*{quote}") for quote in ("'", '"')}
BRACKET: Final = regex(r"[][(){}]")
_BRACKET_OR_LINE_END: Final = regex(r"[][(){}\n]")
_BRACKET_OR_QUOTE: Final = regex(r"""[][(){}'"]""")


@dataclass(frozen=True, slots=True)
class _Fault:
    """The place of a bracket or quotation mark without a partner."""

    # ``opened`` is the place of the innermost open bracket, or -1.
    at: int
    opened: int = -1
    is_quote: bool = False


@once
def pairs(text: str) -> Ends:
    """Map each opening bracket's position to the position after its partner on the same line.

    Brackets without a partner are left out.
    """
    found: dict[int, int] = {}
    stack: list[int] = []
    for sign in _BRACKET_OR_LINE_END.finditer(text):
        i, letter = sign.start(), sign[0]
        if letter in CLOSES:
            stack.append(i)
        elif letter in _OPENS:
            if stack and text[stack[-1]] == _OPENS[letter]:
                found[stack.pop()] = i + 1
        else:
            stack.clear()
    return found


def strict_pairs(source: SourceText) -> Ends:
    """Map the start of each bracket pair or string to the position after its end.

    Raises GridError for a bracket without a partner, or for a string without an end.
    """
    found = _strict(source.text)
    if isinstance(found, _Fault):
        raise _error(source, found)
    return found


@once
def _strict(text: str) -> Ends | _Fault:
    found: dict[int, int] = {}
    stack: list[int] = []
    at = 0
    for sign in _BRACKET_OR_QUOTE.finditer(text):
        i, letter = sign.start(), sign[0]
        if i < at:
            continue
        # After an operand, ' is a transpose and does not begin a string.
        if letter in CLOSES:
            stack.append(i)
        elif letter in _OPENS:
            if not stack or text[stack[-1]] != _OPENS[letter]:
                return _Fault(i, stack[-1] if stack else -1)
            found[stack.pop()] = i + 1
        elif i == 0 or text[i - 1].isspace() or text[i - 1] in "[({,;:=":
            string = _STRINGS[letter].match(text, i)
            if string is None:
                return _Fault(i, is_quote=True)
            found[i] = at = string.end()
    return _Fault(stack[-1]) if stack else found


def _error(source: SourceText, fault: _Fault) -> GridError:
    if not fault.is_quote:
        return _unbalanced(source, fault)
    message = say("This text has no quotation mark at its end. Add it, or delete this one.")
    return GridError("unclosed_quote", message, source.span(fault.at, fault.at + 1))


def _unbalanced(source: SourceText, fault: _Fault) -> GridError:
    at = fault.at
    bracket = source.text[at]
    if bracket in CLOSES:
        message = say(
            "This {bracket} is never closed; {partner} is missing.",
            bracket=bracket,
            partner=CLOSES[bracket],
        )
    elif fault.opened >= 0:
        open_one = source.text[fault.opened]
        message = say(
            "This {bracket} does not fit the {opening} at character {place}; "
            "{wanted} was expected.",
            bracket=bracket,
            opening=open_one,
            place=source.span(fault.opened)[0] + 1,
            wanted=CLOSES[open_one],
        )
    else:
        message = say(
            "This {bracket} was never opened; {partner} is missing.",
            bracket=bracket,
            partner=_OPENS[bracket],
        )
    return GridError("unbalanced_bracket", message, source.span(at, at + 1))


def outside(text: str, signs: str) -> Iterator[int]:
    """Yield the positions of the characters ``signs`` outside all pairs of brackets on a line."""
    # ``signs`` are written as in a class of a regular expression, such as r",\s".
    ends, at = pairs(text), 0
    for sign in _sign(signs).finditer(text):
        i = sign.start()
        if i < at:
            continue
        if sign[0] in CLOSES:
            at = ends.get(i, i)
        else:
            yield i


@cache
def _sign(signs: str) -> re.Pattern[str]:
    return re.compile(rf"[{signs}\[({{]")


def split(source: SourceText, separators: str) -> list[SourceText]:
    """Split a text at these separators, but not inside brackets and quotes.

    Raises GridError for a bracket or a quotation mark without a partner, and for too many pieces.
    """
    text, ends = source.text, strict_pairs(source)
    places, at = [], 0
    for found in _sign(re.escape(separators) + "'\"").finditer(text):
        i = found.start()
        if i < at:
            continue
        at = ends.get(i, i + 1)
        if found[0] in separators:
            places.append(i)
    if len(places) > GRID_LIMITS.separators:
        # Most of them are the commas of LaTeX's thin spaces.
        raise too_many_cells(source.whole)
    return [source.cut(a + 1, b) for a, b in pairwise([-1, *places, len(text)])]
