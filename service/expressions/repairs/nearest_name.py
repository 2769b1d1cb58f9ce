"""Find the known name that is most similar to an unknown name."""

import difflib

from service.expressions.parsing.lexing.words import split
from service.expressions.vocabulary.functions import IN_DEGREES, OF_DEGREES, PI, SPELLINGS
from service.expressions.vocabulary.symbols import Vocabulary, normal_form
from service.regex import regex

# A longer run is not one misspelt name, and comparing it would be slow.
_LONGEST_SLIP = 24
_FEWEST_LETTERS = 3
# The least similarity ratios. A name with exchanged letters (cso for cos) has a lower ratio than
# one with an added letter (coss).
_LEAST = 0.75
_LEAST_OF_EXCHANGED = 0.6
_DIGITS = regex(r"[0-9]+")
# Rare names, which are never suggested.
_OF_DEGREES = frozenset({*OF_DEGREES, *IN_DEGREES, "deg2rad", "rad2deg"})


def other_case(run: str, vocabulary: Vocabulary, called: bool) -> str | None:
    """Return the known name that differs from ``run`` only in letter case, or None.

    ``called`` is True if a bracket follows.
    """
    if len(run) > _LONGEST_SLIP:
        return None
    plain = normal_form(run)
    known = set(SPELLINGS) if called else _names(vocabulary) | {*SPELLINGS, PI[0]}
    lowered = {name.lower(): name for name in sorted(known, reverse=True)}
    if plain.lower() in lowered:
        return lowered[plain.lower()]
    for other in (plain.lower(), plain.upper()):
        if other != plain and not called and split(other, vocabulary) is not None:
            return other
    return None


def nearest(run: str, vocabulary: Vocabulary, called: bool) -> str | None:
    """Return the known name that is most similar to ``run``, or None."""
    plain = normal_form(run)
    if not 1 < len(plain) <= _LONGEST_SLIP:
        # A single letter is similar to too many names.
        return None
    pool = set(SPELLINGS) - _OF_DEGREES if called else _names(vocabulary)
    # A name with another index is another name, and so is a short name with one letter changed.
    pool = {name for name in pool if _DIGITS.findall(name) == _DIGITS.findall(plain)}
    pool = {name for name in pool if _is_slip(name, plain)}
    close = difflib.get_close_matches(plain, sorted(pool), n=2, cutoff=_LEAST_OF_EXCHANGED)
    meanings = {vocabulary.by_name.get(name, name) for name in close}
    if len(meanings) > 1 and _ratio(plain, close[0]) == _ratio(plain, close[1]):
        # Two names with different meanings are equally similar.
        return None
    symbol = vocabulary.by_name.get(close[0]) if close else None
    # Return the canonical name l_base for lbase, but keep an alias such as q1.
    if symbol is not None and normal_form(symbol.name) == close[0]:
        return symbol.name
    return close[0] if close else None


def _is_slip(name: str, typed: str) -> bool:
    letters, other = _DIGITS.sub("", name), _DIGITS.sub("", typed)
    if min(len(letters), len(other)) < _FEWEST_LETTERS:
        return False
    is_near = abs(len(name) - len(typed)) <= 1 and _ratio(typed, name) >= _LEAST
    return is_near or sorted(letters) == sorted(other)


def _ratio(run: str, name: str) -> float:
    return difflib.SequenceMatcher(None, name, run).ratio()


def _names(vocabulary: Vocabulary) -> set[str]:
    return {name for name in vocabulary.by_name if name.isascii()}
