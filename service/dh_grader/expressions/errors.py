"""Errors and notes that reading a text may give.

    TextError            code, message, span
    ├─ ExpressionError   a formula that cannot be read, and its repaired text, if any
    └─ GridError         a pasted text that is not a table or matrix (dh_grader/pasting)

    UnreadableError      the place where the reader stopped; internal, because
                         ``repairs.explain`` turns it into an ExpressionError
    Note                 not an error: the text was read, but it may mean something else

Spans are [from, to) in the text that the student typed.
"""

from dataclasses import dataclass
from typing import Any, Final, Literal

# --- The limits on the size of one expression


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds on one expression."""

    # ``characters`` bounds the typed text, ``nodes`` the size of its tree, and ``depth`` its
    # nesting: consecutive sums or products count as one level. ``tree_depth`` bounds the depth of
    # the tree, where each term of a sum is a level: recursive functions on trees use up to three
    # calls for each level, and Python allows 1,000. A text longer than ``repaired`` characters gets
    # no suggestion and is not searched for typical mistakes. ``notes`` bounds the number of notes
    # on a text.
    # The longest entry of a seven-joint arm's pose, expanded and not simplified, has 2,500
    # characters in LaTeX and 270 nodes.

    characters: int = 8_000
    nodes: int = 2_000
    depth: int = 40
    tree_depth: int = 200
    repaired: int = 1_000
    notes: int = 12


LIMITS = Limits()


# --- Errors and notes


Span = tuple[int, int]

Cause = Literal[
    "ambiguous_number", "ambiguous_shorthand", "ambiguous_star", "ambiguous_unit", "argument",
    "arguments", "beyond", "boolean", "character", "command", "cube_root", "degrees", "empty",
    "function_power", "grammar", "index", "invalid_shorthand", "invisible", "look_alike",
    "mismatch", "mixed_number", "name", "not_finite", "plus_minus", "quantity", "raised_zero",
    "subscript",
    "transpose", "two_units", "unclosed", "unit_on_variable", "values",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Note:
    """A remark on how a text was read."""

    code: str
    message: str
    span: Span


class TextError(Exception):
    """A text cannot be read. All errors of one kind have the same ``code``."""

    def __init__(self, code: str, message: str, span: Span, *details: object) -> None:
        super().__init__(code, message, span, *details)
        self.code = code
        self.message = message
        self.span = span

    def __str__(self) -> str:
        return self.message


class ExpressionError(TextError):
    """A formula cannot be read.

    ``suggestion`` is the whole repaired text, or None. ``tried`` is the number of symbols that were
    read to find a suggestion.
    """

    def __init__(self, code: str, message: str, span: Span, suggestion: str | None = None) -> None:
        super().__init__(code, message, span, suggestion)
        self.suggestion = suggestion
        self.tried = 0

    def without_traceback(self) -> "ExpressionError":
        """Return a copy of this error without a traceback."""
        error = ExpressionError(self.code, self.message, self.span, self.suggestion)
        error.tried = self.tried
        return error


class UnreadableError(Exception):
    """A formula cannot be read further than the position ``span``.

    ``cause`` is the kind of problem, and ``details`` are values for the message about it.
    """

    def __init__(self, cause: Cause, span: Span, **details: Any) -> None:
        super().__init__(cause, span, details)
        self.cause = cause
        self.span = span
        self.details = details


# --- Quotations of the typed text in messages


# A longer quotation is shortened.
_LONGEST_QUOTATION: Final = 40


def shortened(text: str) -> str:
    """Return ``text``, or only the beginning if it is long."""
    return text if len(text) <= _LONGEST_QUOTATION else f"{text[:_LONGEST_QUOTATION]}…"


def quoted(text: str) -> str:
    """Return ``text`` as messages quote it: shortened, or as code points if it is unprintable."""
    text = shortened(text)
    if all(letter.isprintable() for letter in text):
        return f"`{text}`"
    return " ".join(f"U+{ord(letter):04X}" for letter in text)
