"""Find pairs of brackets and quotes. A separator inside a pair does not split a cell."""

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Final

from service.grids.cutting.grid import GridError
from service.grids.cutting.source_text import SourceText
from service.translations import say

CLOSES: Final = {"[": "]", "(": ")", "{": "}"}
_OPENS: Final = {closer: opener for opener, closer in CLOSES.items()}
_STRINGS: Final = {
    quote: re.compile(rf"{quote}(?:[^\\{quote}\n]|\\.)*{quote}") for quote in ("'", '"')
}
BRACKET: Final = re.compile(r"[][(){}]")
_BRACKET_OR_LINE_END: Final = re.compile(r"[][(){}\n]")
_BRACKET_OR_QUOTE: Final = re.compile(r"""[][(){}'"]""")


def pairs(text: str) -> dict[int, int]:
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


def strict_pairs(source: SourceText) -> dict[int, int]:
    """Map the start of each bracket pair or string to the position after its end.

    Raises GridError for a bracket without a partner, or for a string without an end.
    """
    text = source.text
    found: dict[int, int] = {}
    stack: list[int] = []
    at = 0
    while sign := _BRACKET_OR_QUOTE.search(text, at):
        i, letter = sign.start(), sign[0]
        at = i + 1
        # After an operand, ' is a transpose and does not begin a string.
        if letter in _STRINGS and (i == 0 or text[i - 1].isspace() or text[i - 1] in "[({,;:="):
            string = _STRINGS[letter].match(text, i)
            if string is None:
                message = say(
                    "This text has no quotation mark at its end. Add it, or delete this one."
                )
                raise GridError("unclosed_quote", message, source.span(i, i + 1))
            found[i] = at = string.end()
        elif letter in CLOSES:
            stack.append(i)
        elif letter in _OPENS:
            if not stack or text[stack[-1]] != _OPENS[letter]:
                raise _unbalanced(source, i, stack)
            found[stack.pop()] = i + 1
    if stack:
        raise _unbalanced(source, stack[-1], [])
    return found


def _unbalanced(source: SourceText, at: int, stack: list[int]) -> GridError:
    bracket = source.text[at]
    if bracket in CLOSES:
        message = say(
            "This {bracket} is never closed; {partner} is missing.",
            bracket=bracket,
            partner=CLOSES[bracket],
        )
    elif stack:
        open_one = source.text[stack[-1]]
        message = say(
            "This {bracket} does not fit the {opening} at character {place}; "
            "{wanted} was expected.",
            bracket=bracket,
            opening=open_one,
            place=source.span(stack[-1])[0] + 1,
            wanted=CLOSES[open_one],
        )
    else:
        message = say(
            "This {bracket} was never opened; {partner} is missing.",
            bracket=bracket,
            partner=_OPENS[bracket],
        )
    return GridError("unbalanced_bracket", message, source.span(at, at + 1))


def outside(text: str, ends: dict[int, int]) -> Iterator[int]:
    """Yield the positions of the characters outside all pairs of brackets and quotes."""
    # ``ends`` maps the start of a pair to its end.
    i = 0
    while i < len(text):
        if i in ends:
            i = ends[i]
        else:
            yield i
            i += 1


def split(source: SourceText, separators: str) -> list[SourceText]:
    """Split a text at these separators, but not inside brackets and quotes.

    Raises GridError for a bracket or a quotation mark without a partner.
    """
    text, ends = source.text, strict_pairs(source)
    places, at = [], 0
    sign = re.compile(f"[{re.escape(separators)}\\[({{'\"]")
    while found := sign.search(text, at):
        i = found.start()
        at = ends.get(i, i + 1)
        if found[0] in separators:
            places.append(i)
    return [source.cut(a + 1, b) for a, b in pairwise([-1, *places, len(text)])]
