"""The known names that are nearest to an unknown one."""

import difflib

from service.expressions.parsing.words import split
from service.expressions.vocabulary.functions import IN_DEGREES, OF_DEGREES, PI, SPELLINGS
from service.expressions.vocabulary.symbols import Vocabulary, normal_form

# A longer run is no slip of one name, and comparing it would cost time.
_LONGEST_SLIP = 24
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
    # A name of a very different length is not near.
    pool = {name for name in pool if abs(len(name) - len(plain)) <= max(1, len(plain) // 3)}
    close = difflib.get_close_matches(plain, sorted(pool), n=2, cutoff=0.6)
    meanings = {vocabulary.by_name.get(name, name) for name in close}
    if len(meanings) > 1 and _ratio(plain, close[0]) == _ratio(plain, close[1]):
        # Of theta1 and theta2 neither is meant more than the other.
        return None
    symbol = vocabulary.by_name.get(close[0]) if close else None
    # The canonical name l_base for lbase; an alias, q1, stays as it is.
    if symbol is not None and normal_form(symbol.name) == close[0]:
        return symbol.name
    return close[0] if close else None


def _ratio(run: str, name: str) -> float:
    return difflib.SequenceMatcher(None, name, run).ratio()


def _names(vocabulary: Vocabulary) -> set[str]:
    return {name for name in vocabulary.by_name if name.isascii()}
