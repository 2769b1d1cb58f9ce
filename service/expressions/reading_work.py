"""Estimate the cost of reading a text before it is read."""

# Every machine gets the same result.

from collections import Counter
from functools import lru_cache
from typing import Final, NamedTuple

from service.expressions.characters.unicode import SUBSCRIPTS, SUPERSCRIPTS
from service.regex import regex

# A name, a number or a sign. Long runs of letters are counted in pairs. Blanks are free.
_SYMBOL: Final = regex(r"\\[A-Za-z]+|[A-Za-z]{1,2}|[0-9.]+|[^A-Za-z0-9. ]")
# Characters that become several: ½ ² ₁.
_COMPOSED: Final = regex("[¼-¾⅐-⅞↉" + "".join((*SUPERSCRIPTS, *SUBSCRIPTS)) + "]")
_SYMBOLS_IN_COMPOSED: Final = 5
# Every character costs a little, also a blank.
_CHARACTERS_PER_SYMBOL: Final = 16

# A fraction in LaTeX costs as much as ten of its braces, a root as six, a quotient as three.
_EXTRA: Final = {r"\frac": 9, r"\dfrac": 9, r"\tfrac": 9, r"\sqrt": 5, "√": 5, "/": 2}
# A function of degrees becomes two operations. A name of one or two letters is a whole factor.
_OF_DEGREES: Final = regex(r"(?:sin|cos|tan)d")
_SHORT_NAME: Final = regex(r"(?<![A-Za-z\\])[A-Za-z]{1,2}(?![A-Za-z0-9_])")
# Each match becomes a leaf of the tree. A long name such as ``numpy`` counts once.
_NAME_OR_NUMBER: Final = regex(r"(?<![A-Za-z\\])[A-Za-z]+|[0-9][0-9.]*")
_NUMBER: Final = regex(r"[0-9][0-9.]*")
# ½ is a quotient in brackets.
_FRACTION: Final = regex("[¼-¾⅐-⅞↉]")
_EXTRA_OF_FRACTION: Final = 5
# c12 is the cosine of a sum.
_SHORTHAND: Final = regex(r"(?<![A-Za-z\\])[cs]\d{2}")
# The sine of a number is checked for a note, because degrees may be meant.
_OF_NUMBER: Final = regex(r"(?:sin|cos|tan)\(\d")
_EXTRA_OF_DEGREES, _EXTRA_OF_SHORT_NAME, _EXTRA_OF_SHORTHAND, _EXTRA_OF_NUMBER = 10, 4, 5, 2
# The extra cost of shorter texts is ignored: the largest answers have only 300 of them.
_WORTH_IT: Final = 40

# Text that is counted as a unit. Only the last pattern above may match across such words.
_NAME: Final = regex(r"\\?[A-Za-z0-9_.]+")
_WORD: Final = regex(rf"{_NAME.pattern}|[^ ]")
# A formula has few distinct words, which are memoized. Other texts are counted as a whole.
_MOST_WORDS: Final = 100
# More symbols than any text has.
_PACKED: Final = 1 << 32

# Most texts are read repeatedly, so their counts are memoized, but longer texts need much memory.
_LONGEST_CACHED: Final = 500


class _Count(NamedTuple):
    symbols: int
    extra: int


def symbols_in(text: str) -> int:
    """Estimate the number of names, numbers and signs in a text."""
    # The estimate is never much too low.
    return _of_text(text).symbols


def reading_cost(text: str) -> int:
    """Estimate the cost of reading a text, as a number of symbols."""
    # In a long text, symbols are weighted by their cost. Braces and similar symbols of LaTeX cost
    # little.
    symbols, extra = _of_text(text)
    return symbols + extra if len(text) > _WORTH_IT else symbols


def _of_text(text: str) -> _Count:
    return _memoized(text) if len(text) <= _LONGEST_CACHED else _by_words(text)


def _by_words(text: str) -> _Count:
    characters = len(text) // _CHARACTERS_PER_SYMBOL
    if len(text) <= _MOST_WORDS and text.isascii():
        # A fast path for most formulas: signs are counted, not looked up one by one.
        words = _NAME.findall(text)
        signs = len(text) - text.count(" ") - sum(map(len, words))
        extra, symbols = divmod(sum(map(_of_word, words)), _PACKED)
        return _Count(
            symbols + signs + characters, extra + _EXTRA["/"] * text.count("/") + _of_numbers(text)
        )
    words = _WORD.findall(text)
    if len(words) > _MOST_WORDS and len(set(words)) > _MOST_WORDS:
        symbols, extra = _scanned(text)
        return _Count(symbols + characters, extra)
    extra, symbols = divmod(sum(map(_of_word, words)), _PACKED)
    return _Count(symbols + characters, extra + _of_numbers(text))


def _of_numbers(text: str) -> int:
    if "n(" in text or "s(" in text:
        return _EXTRA_OF_NUMBER * len(_OF_NUMBER.findall(text))
    return 0


def _packed(word: str) -> int:
    # Return the number of symbols in a word and their extra cost, packed into one integer.
    # So the counts of many words can be summed at once.
    # A fast path: numbers are the words that are new most often.
    symbols, extra = (1, 1) if _NUMBER.fullmatch(word) else _scanned(word)
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


_memoized: Final = lru_cache(maxsize=8192)(_by_words)
_of_word: Final = lru_cache(maxsize=2048)(_packed)
