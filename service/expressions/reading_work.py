"""The work of reading a text, counted before it is read and the same on every machine."""

import re
from collections import Counter
from functools import lru_cache
from typing import Final

from service.expressions.characters.unicode import SUBSCRIPTS, SUPERSCRIPTS

# A name, a number or a sign; of long runs of letters each piece is looked up. A blank is free.
_SYMBOL: Final = re.compile(r"\\[A-Za-z]+|[A-Za-z]{1,2}|[0-9.]+|[^A-Za-z0-9. ]")
# Characters that stand for several: ½ ² ₁.
_COMPOSED: Final = re.compile("[¼-¾⅐-⅞↉" + "".join((*SUPERSCRIPTS, *SUBSCRIPTS)) + "]")
_SYMBOLS_IN_COMPOSED: Final = 5
# Each character is looked at once, whatever it is.
_CHARACTERS_PER_SYMBOL: Final = 16


# A fraction in LaTeX costs as much as ten of its braces, a root as six, a quotient as three.
_EXTRA: Final = {r"\frac": 9, r"\dfrac": 9, r"\tfrac": 9, r"\sqrt": 5, "√": 5, "/": 2}
# A function of degrees becomes two operations. A name of one or two letters is all of a factor.
_OF_DEGREES: Final = re.compile(r"(?:sin|cos|tan)d")
_SHORT_NAME: Final = re.compile(r"(?<![A-Za-z\\])[A-Za-z]{1,2}(?![A-Za-z0-9_])")
# Each becomes a leaf of the tree; ``numpy`` before a function is one name, however long.
_NAME_OR_NUMBER: Final = re.compile(r"(?<![A-Za-z\\])[A-Za-z]+|[0-9][0-9.]*")
# ½ is a quotient in brackets.
_FRACTION: Final = re.compile("[¼-¾⅐-⅞↉]")
_EXTRA_OF_FRACTION: Final = 3
# c12 is the cosine of a sum.
_SHORTHAND: Final = re.compile(r"(?<![A-Za-z\\])[cs]\d{2}")
_EXTRA_OF_DEGREES, _EXTRA_OF_SHORT_NAME, _EXTRA_OF_SHORTHAND = 10, 4, 3
# Shorter texts are not worth the second look: the largest answers have 300 of them.
_WORTH_IT: Final = 40

# Most texts are read again and again; longer ones are not worth the memory.
_LONGEST_REMEMBERED: Final = 500


def symbols_in(text: str) -> int:
    """The names, numbers and signs that a text is read as, roughly and never far too few."""
    return _remembered(text) if len(text) <= _LONGEST_REMEMBERED else _counted(text)


def reading_cost(text: str) -> int:
    """The symbols of a text, each of a long text counted by what it costs to read.

    What LaTeX writes beside the others, as braces, costs little.
    """
    return _weighed(text) if len(text) <= _LONGEST_REMEMBERED else _weigh(text)


def _weigh(text: str) -> int:
    found = symbols_in(text)
    if len(text) <= _WORTH_IT:
        return found
    for symbol, times in Counter(_SYMBOL.findall(text)).items():
        found += times * _EXTRA.get(symbol, 0)
    found += len(_NAME_OR_NUMBER.findall(text))
    found += _EXTRA_OF_DEGREES * len(_OF_DEGREES.findall(text))
    found += _EXTRA_OF_SHORTHAND * len(_SHORTHAND.findall(text))
    if not text.isascii():
        found += _EXTRA_OF_FRACTION * len(_FRACTION.findall(text))
    return found + _EXTRA_OF_SHORT_NAME * len(_SHORT_NAME.findall(text))


def _counted(text: str) -> int:
    found = len(_SYMBOL.findall(text)) + len(text) // _CHARACTERS_PER_SYMBOL
    if text.isascii():
        return found
    return found + _SYMBOLS_IN_COMPOSED * len(_COMPOSED.findall(text))


_remembered: Final = lru_cache(maxsize=8192)(_counted)
_weighed: Final = lru_cache(maxsize=8192)(_weigh)
