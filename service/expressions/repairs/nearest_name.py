"""The known names that are nearest to an unknown one."""

import difflib
import re

from service.expressions.parsing.lexing.words import split
from service.expressions.vocabulary.functions import IN_DEGREES, OF_DEGREES, PI, SPELLINGS
from service.expressions.vocabulary.symbols import Vocabulary, normal_form

# A longer run is no slip of one name, and comparing it would cost time.
_LONGEST_SLIP = 24
_FEWEST_LETTERS = 3
# The likeness of names: cso is less like cos than coss is, though it is cos with letters exchanged.
_LEAST = 0.75
_LEAST_OF_EXCHANGED = 0.6
_DIGITS = re.compile(r"[0-9]+")
# Rare names, which are never offered.
_OF_DEGREES = frozenset({*OF_DEGREES, *IN_DEGREES, "deg2rad", "rad2deg"})


def other_case(run: str, vocabulary: Vocabulary, called: bool) -> str | None:
    """``run`` with other capitals, where that is known, or None.

    ``called`` tells that a bracket follows.
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
    """The known name nearest to ``run``, or None."""
    plain = normal_form(run)
    if not 1 < len(plain) <= _LONGEST_SLIP:
        # One letter is as near to pi as to exp.
        return None
    pool = set(SPELLINGS) - _OF_DEGREES if called else _names(vocabulary)
    # Another index, or a letter more or less of a short name, is another name.
    pool = {name for name in pool if _DIGITS.findall(name) == _DIGITS.findall(plain)}
    pool = {name for name in pool if _is_slip(name, plain)}
    close = difflib.get_close_matches(plain, sorted(pool), n=2, cutoff=_LEAST_OF_EXCHANGED)
    meanings = {vocabulary.by_name.get(name, name) for name in close}
    if len(meanings) > 1 and _ratio(plain, close[0]) == _ratio(plain, close[1]):
        # Of theta1 and theta2 neither is meant more than the other.
        return None
    symbol = vocabulary.by_name.get(close[0]) if close else None
    # The canonical name l_base for lbase; an alias, q1, stays as it is.
    if symbol is not None and normal_form(symbol.name) == close[0]:
        return symbol.name
    return close[0] if close else None


def _is_slip(name: str, typed: str) -> bool:
    """Whether both have three letters or more, and nearly the same ones."""
    letters, other = _DIGITS.sub("", name), _DIGITS.sub("", typed)
    if min(len(letters), len(other)) < _FEWEST_LETTERS:
        return False
    is_near = abs(len(name) - len(typed)) <= 1 and _ratio(typed, name) >= _LEAST
    return is_near or sorted(letters) == sorted(other)


def _ratio(run: str, name: str) -> float:
    return difflib.SequenceMatcher(None, name, run).ratio()


def _names(vocabulary: Vocabulary) -> set[str]:
    return {name for name in vocabulary.by_name if name.isascii()}
