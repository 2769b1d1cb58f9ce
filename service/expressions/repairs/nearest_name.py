"""The known names that an unknown one was probably meant to be."""

import difflib

from service.expressions.parsing.words import split
from service.expressions.vocabulary.functions import IN_DEGREES, OF_DEGREES, PI, SPELLINGS
from service.expressions.vocabulary.symbols import Vocabulary, normal_form

# A longer run is no slip of one name, and comparing it would cost time.
_LONGEST_SLIP = 24
# Nobody means these by a name that is nearly theirs.
_OF_DEGREES = frozenset({*OF_DEGREES, *IN_DEGREES, "deg2rad", "rad2deg"})


def other_case(run: str, vocabulary: Vocabulary, called: bool) -> str | None:
    """Return `run` with the capitals that the known names have, or None.

    `called` tells that a bracket follows it.
    """
    if len(run) > _LONGEST_SLIP:
        return None
    plain = normal_form(run)
    lowered = {name.lower(): name for name in sorted(_known(vocabulary, called), reverse=True)}
    if plain.lower() in lowered:
        return lowered[plain.lower()]
    for other in (plain.lower(), plain.upper()):
        if other != plain and not called and split(other, vocabulary) is not None:
            return other
    return None


def nearest(run: str, vocabulary: Vocabulary, called: bool) -> str | None:
    """Return the known name that `run` was probably meant to be, or None."""
    plain = normal_form(run)
    if not 1 < len(plain) <= _LONGEST_SLIP:
        # One letter is as near to pi as to exp: there is no telling.
        return None
    pool = set(SPELLINGS) - _OF_DEGREES if called else _names(vocabulary)
    # Nor is a name near that leaves out most of what was written.
    pool = {name for name in pool if abs(len(name) - len(plain)) <= max(1, len(plain) // 3)}
    close = difflib.get_close_matches(plain, sorted(pool), n=1, cutoff=0.6)
    return _as_declared(close[0], vocabulary) if close else None


def _as_declared(name: str, vocabulary: Vocabulary) -> str:
    """Return l_base for lbase; an alias, q1, stays what it is."""
    symbol = vocabulary.by_name.get(name)
    return symbol.name if symbol is not None and normal_form(symbol.name) == name else name


def _names(vocabulary: Vocabulary) -> set[str]:
    return {name for name in vocabulary.by_name if name.isascii()}


def _known(vocabulary: Vocabulary, called: bool) -> set[str]:
    return set(SPELLINGS) if called else _names(vocabulary) | {*SPELLINGS, PI[0]}
