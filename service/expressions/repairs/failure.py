"""The argument of a repair rule, its type, and helpers of several rules."""

from collections.abc import Callable
from functools import wraps
from typing import Final, Protocol

from service.expressions.errors import Cause, ExpressionError, Span, UnreadableError, quoted
from service.expressions.vocabulary.symbols import Vocabulary

# The error for a failure, or None for another slip; its suggestion may be unreadable.
Repair = ExpressionError | None


class Failure:
    """A text that could not be read, and the ``error`` that stopped the reader.

    ``repaired`` reads another text: it returns that text where it can be read, else its own
    repaired text, else None.
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
        # Each rule asks for the cause.
        self.cause: Final[Cause] = error.cause
        self.span: Final = error.span
        self.details: Final = error.details
        self.repaired: Final = repaired

    @property
    def written(self) -> str:
        """The text at the place where reading stopped."""
        return self.source[self.span[0] : self.span[1]]

    def replaced(self, text: str, span: Span | None = None) -> str:
        """The source with ``text`` in place of ``span``, by default the span of the error."""
        start, end = span or self.span
        return self.source[:start] + text + self.source[end:]

    def terminal(self, back: int = 0) -> str:
        """The token that the grammar could not take, or the one ``back`` before it.

        Empty where there is none, or where something else stopped the reader.
        """
        at = self.details["index"] - back if self.cause == "grammar" else -1
        return "" if at < 0 else self.details["tokens"][at][0]

    def place(self, back: int = 0) -> Span:
        """The place of the token that ``terminal`` names."""
        token = self.details["tokens"][self.details["index"] - back]
        return token[2], token[3]


class RepairRule(Protocol):
    """A module with the rule for one kind of slip."""

    __name__: str

    def repair(self, failure: Failure, /) -> Repair:
        """The error for ``failure``, or None for another slip; its suggestion may be unreadable."""


def answers(*causes: Cause) -> Callable[[Callable[[Failure], Repair]], Callable[[Failure], Repair]]:
    """Ask the rule only where the reader stopped for one of these causes."""

    def decorate(rule: Callable[[Failure], Repair]) -> Callable[[Failure], Repair]:
        @wraps(rule)
        def repair(failure: Failure) -> Repair:
            return rule(failure) if failure.cause in causes else None

        return repair

    return decorate


def refusal(cause: Cause, code: str, message: str) -> Callable[[Failure], Repair]:
    """The rule that answers each failure of this cause with this message."""
    return answers(cause)(lambda failure: error(failure, code, message))


def error(
    failure: Failure,
    code: str,
    message: str,
    suggestion: str | None = None,
    span: Span | None = None,
) -> ExpressionError:
    """The error for ``failure``, by default at its span."""
    return ExpressionError(code, message, span or failure.span, suggestion)


def absent(failure: Failure) -> str:
    """The sentence that the name in the text is not declared."""
    name = quoted(failure.written)
    if failure.vocabulary.of_books:
        return f"There is no {name} here."
    return f"This exercise has no {name}."


def position(span: Span) -> str:
    """The first character of ``span``, counted from 1."""
    return f"character {span[0] + 1}"


__all__ = [
    "Failure", "Repair", "RepairRule", "absent", "answers", "error", "position", "quoted",
    "refusal",
]  # fmt: skip
