"""The work of reading a text, counted before it is read and the same on every machine."""

import re
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


# Most texts are read again and again; longer ones are not worth the memory.
_LONGEST_REMEMBERED: Final = 500


def symbols_in(text: str) -> int:
    """The names, numbers and signs that a text is read as, roughly and never far too few."""
    return _remembered(text) if len(text) <= _LONGEST_REMEMBERED else _counted(text)


def _counted(text: str) -> int:
    found = len(_SYMBOL.findall(text)) + len(text) // _CHARACTERS_PER_SYMBOL
    if text.isascii():
        return found
    return found + _SYMBOLS_IN_COMPOSED * len(_COMPOSED.findall(text))


_remembered: Final = lru_cache(maxsize=8192)(_counted)
