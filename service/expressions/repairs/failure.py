"""What a repair rule is given, what it answers with, and what most of them need."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from service.expressions.errors import ExpressionError, Span
from service.expressions.parsing.lexer import Token
from service.expressions.unreadable import UnreadableError
from service.expressions.vocabulary.symbols import Vocabulary


@dataclass(frozen=True, slots=True)
class Failure:
    """A text that could not be read, and where reading stopped.

    `repaired` tries another text: it returns that text where it can be read, else what it would
    itself be repaired to, else None.
    """

    source: str
    vocabulary: Vocabulary
    stop: UnreadableError
    repaired: Callable[[str], str | None]

    @property
    def span(self) -> Span:
        """Where reading stopped."""
        return self.stop.span

    @property
    def written(self) -> str:
        """What stands where reading stopped."""
        return self.source[self.span[0] : self.span[1]]

    @property
    def details(self) -> dict[str, Any]:
        """What else the reader saw."""
        return self.stop.details

    def replaced(self, text: str, span: Span | None = None) -> str:
        """Return the source with `text` in place of `span`, or of where reading stopped."""
        start, end = span or self.span
        return self.source[:start] + text + self.source[end:]


class Rule(Protocol):
    """One way to go wrong: the error that names it, or None where this is another one."""

    def __call__(self, failure: Failure) -> ExpressionError | None:
        """Return the error for `failure`; its suggestion need not be readable."""


@dataclass(frozen=True, slots=True)
class Halt:
    """The token that the grammar could not take, and the tokens before it."""

    tokens: Sequence[Token]
    index: int

    @property
    def terminal(self) -> str:
        """What could not be taken."""
        return self.tokens[self.index][0]

    @property
    def before(self) -> str:
        """What stands before it, or nothing."""
        return self.tokens[self.index - 1][0] if self.index else ""

    def span(self, back: int = 0) -> Span:
        """Return the place of the token, or of one that lies `back` before it."""
        return self.tokens[self.index - back][2:]


def halt(failure: Failure) -> Halt | None:
    """Return where the grammar stopped, or None where it was not the grammar that stopped."""
    if failure.stop.cause != "grammar":
        return None
    return Halt(failure.details["tokens"], failure.details["index"])


def shown(text: str) -> str:
    """Return `text` so that it can be quoted in a message, whatever its characters."""
    if all(letter.isprintable() for letter in text):
        return f"`{text}`"
    return " ".join(f"U+{ord(letter):04X}" for letter in text)


def place(span: Span) -> str:
    """Return where a span begins, as people count."""
    return f"character {span[0] + 1}"
