"""The argument of a repair rule, its type, and helpers of several rules."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from service.expressions.errors import Cause, ExpressionError, Span, UnreadableError
from service.expressions.parsing.lexer import Token
from service.expressions.vocabulary.symbols import Vocabulary


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


class RepairRule(Protocol):
    """The rule for one kind of slip."""

    def __call__(self, failure: Failure) -> ExpressionError | None:
        """The error for ``failure``, or None for another slip; its suggestion may be unreadable."""


@dataclass(frozen=True, slots=True)
class UnexpectedToken:
    """The token that the grammar could not take, at ``index`` of the ``tokens``."""

    tokens: Sequence[Token]
    index: int

    @property
    def terminal(self) -> str:
        """The token's terminal."""
        return self.tokens[self.index][0]

    @property
    def before(self) -> str:
        """The terminal before it; empty where it is the first."""
        return self.tokens[self.index - 1][0] if self.index else ""

    def span(self, back: int = 0) -> Span:
        """The place of the token, or of the one that stands ``back`` tokens before it."""
        return self.tokens[self.index - back][2:]


def unexpected_token(failure: Failure) -> UnexpectedToken | None:
    """The token at which the grammar stopped, or None where something else stopped the reader."""
    if failure.cause != "grammar":
        return None
    return UnexpectedToken(failure.details["tokens"], failure.details["index"])


def quoted(text: str) -> str:
    """``text`` as a message quotes it, with the numbers of letters that cannot be printed."""
    if all(letter.isprintable() for letter in text):
        return f"`{text}`"
    return " ".join(f"U+{ord(letter):04X}" for letter in text)


def position(span: Span) -> str:
    """The first character of ``span``, counted from 1."""
    return f"character {span[0] + 1}"
