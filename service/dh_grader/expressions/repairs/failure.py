"""The input and the result of a repair rule, and what several rules share.

The rules themselves are in ``names.py``, ``numbers.py`` and ``texts.py``.
"""

import difflib
from collections.abc import Callable
from functools import wraps
from typing import Final

from dh_grader.expressions.errors import Cause, ExpressionError, Span, UnreadableError, quoted
from dh_grader.expressions.vocabulary import (
    IN_DEGREES,
    OF_DEGREES,
    PI,
    SPELLINGS,
    Vocabulary,
    normal_form,
)
from dh_grader.expressions.words import split
from dh_grader.regex import regex
from dh_grader.translations import say

# --- The input and the result of a repair rule, and what several rules need to make an error


# The error that a rule returns, or None if it does not apply. The suggestion may be unreadable.
Repair = ExpressionError | None


class Failure:
    """A text that could not be read, and the ``error`` that stopped the reader.

    The function ``repaired`` returns a readable form of another text, or None.
    """

    __slots__ = ("cause", "details", "repaired", "source", "span", "vocabulary")

    def __init__(
        self,
        source: str,
        vocabulary: Vocabulary,
        error: UnreadableError,
        repaired: Callable[[str], str | None],
    ) -> None:
        self.source: Final = source
        self.vocabulary: Final = vocabulary
        # Copied from ``error``, because every rule uses it.
        self.cause: Final[Cause] = error.cause
        self.span: Final = error.span
        self.details: Final = error.details
        self.repaired: Final = repaired

    @property
    def written(self) -> str:
        """The text at the place where reading stopped."""
        return self.source[self.span[0] : self.span[1]]

    def replaced(self, text: str, span: Span | None = None) -> str:
        """Return the source with ``span`` (default: the error's span) replaced by ``text``."""
        start, end = span or self.span
        return self.source[:start] + text + self.source[end:]

    def terminal(self, back: int = 0) -> str:
        """Return the kind of the token ``back`` tokens before the unreadable token, or ""."""
        at = self.details["index"] - back if self.cause == "grammar" else -1
        return "" if at < 0 else self.details["tokens"][at][0]

    def place(self, back: int = 0) -> Span:
        """Return the position of the token ``back`` tokens before the unreadable token."""
        token = self.details["tokens"][self.details["index"] - back]
        return token[2], token[3]


# Returns the error for a failure, or None if the rule does not apply.
RepairRule = Callable[[Failure], Repair]


def for_causes(
    *causes: Cause,
) -> Callable[[RepairRule], RepairRule]:
    """Return a decorator that limits a rule to these causes."""

    def decorate(rule: RepairRule) -> RepairRule:
        @wraps(rule)
        def repair(failure: Failure) -> Repair:
            return rule(failure) if failure.cause in causes else None

        return repair

    return decorate


def refusal(cause: Cause, code: str, message: str) -> Callable[[Failure], Repair]:
    """Return a rule that answers each failure of this cause with the same message."""
    return for_causes(cause)(lambda failure: error(failure, code, message))


def error(
    failure: Failure,
    code: str,
    message: str,
    suggestion: str | None = None,
    span: Span | None = None,
) -> ExpressionError:
    """Return an error at ``span``, by default the span of ``failure``."""
    return ExpressionError(code, message, span or failure.span, suggestion)


def undeclared(failure: Failure) -> str:
    """Return a sentence which says that the unknown name is not declared."""
    name = quoted(failure.written)
    if failure.vocabulary.of_books:
        return say("There is no {name} here.", name=name)
    return say("This exercise has no {name}.", name=name)


# --- Find the known name that is most similar to an unknown name


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
