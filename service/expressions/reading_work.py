"""The work of reading a text, counted before it is read and the same on every machine."""

import re
from collections import Counter
from functools import lru_cache
from typing import Final, NamedTuple

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
_EXTRA_OF_FRACTION: Final = 5
# c12 is the cosine of a sum.
_SHORTHAND: Final = re.compile(r"(?<![A-Za-z\\])[cs]\d{2}")
# That of a number may be meant in degrees, which is looked into.
_OF_NUMBER: Final = re.compile(r"(?:sin|cos|tan)\(\d")
_EXTRA_OF_DEGREES, _EXTRA_OF_SHORT_NAME, _EXTRA_OF_SHORTHAND, _EXTRA_OF_NUMBER = 10, 4, 5, 2
# Shorter texts are not worth the extra: the largest answers have 300 of them.
_WORTH_IT: Final = 40

# What is counted together: but for the last one, none of the patterns above looks beyond it.
_WORD: Final = re.compile(r"\\?[A-Za-z0-9_.]+|[^ ]")
# A formula has few words, which come again and again. Other texts are counted in one piece.
_MOST_WORDS: Final = 100
# More symbols than any text has.
_PACKED: Final = 1 << 32

# Most texts are read again and again; longer ones are not worth the memory.
_LONGEST_REMEMBERED: Final = 500


class _Count(NamedTuple):
    """The symbols of a text, and what some of them cost more than others."""

    symbols: int
    extra: int


def symbols_in(text: str) -> int:
    """The names, numbers and signs that a text is read as, roughly and never far too few."""
    return _of_text(text).symbols


def reading_cost(text: str) -> int:
    """The symbols of a text, each of a long text counted by what it costs to read.

    What LaTeX writes beside the others, as braces, costs little.
    """
    symbols, extra = _of_text(text)
    return symbols + extra if len(text) > _WORTH_IT else symbols


def _of_text(text: str) -> _Count:
    return _remembered(text) if len(text) <= _LONGEST_REMEMBERED else _by_words(text)


def _by_words(text: str) -> _Count:
    characters = len(text) // _CHARACTERS_PER_SYMBOL
    words = _WORD.findall(text)
    if len(words) > _MOST_WORDS and len(set(words)) > _MOST_WORDS:
        symbols, extra = _scanned(text)
        return _Count(symbols + characters, extra)
    extra, symbols = divmod(sum(map(_of_word, words)), _PACKED)
    if "n(" in text or "s(" in text:
        extra += _EXTRA_OF_NUMBER * len(_OF_NUMBER.findall(text))
    return _Count(symbols + characters, extra)


def _packed(word: str) -> int:
    """The count of a word as one number: that of many words is then summed in one call."""
    symbols, extra = _scanned(word)
    return symbols + _PACKED * extra


def _scanned(text: str) -> _Count:
    found = _SYMBOL.findall(text)
    symbols = len(found)
    extra = sum(times * _EXTRA.get(symbol, 0) for symbol, times in Counter(found).items())
    extra += len(_NAME_OR_NUMBER.findall(text))
    extra += _EXTRA_OF_DEGREES * len(_OF_DEGREES.findall(text))
    extra += _EXTRA_OF_SHORTHAND * len(_SHORTHAND.findall(text))
    extra += _EXTRA_OF_SHORT_NAME * len(_SHORT_NAME.findall(text))
    extra += _EXTRA_OF_NUMBER * len(_OF_NUMBER.findall(text))
    if not text.isascii():
        symbols += _SYMBOLS_IN_COMPOSED * len(_COMPOSED.findall(text))
        extra += _EXTRA_OF_FRACTION * len(_FRACTION.findall(text))
    return _Count(symbols, extra)


_remembered: Final = lru_cache(maxsize=8192)(_by_words)
_of_word: Final = lru_cache(maxsize=2048)(_packed)
