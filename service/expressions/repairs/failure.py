"""The input and the result of a repair rule, and helpers that several rules share."""

from collections.abc import Callable
from functools import wraps
from typing import Final

from service.expressions.errors import Cause, ExpressionError, Span, UnreadableError, quoted
from service.expressions.vocabulary.symbols import Vocabulary
from service.translations import say

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


__all__ = [
    "Failure",
    "Repair",
    "RepairRule",
    "error",
    "for_causes",
    "quoted",
    "refusal",
    "undeclared",
]  # fmt: skip
