"""Errors and notes on a text that is read.

    TextError            code, message, span
    ├─ ExpressionError   a formula that cannot be read, and its repaired text where one is near
    └─ GridError         a pasted text that is no table or matrix (service/grids)

    UnreadableError      the place where the reader stopped; it never leaves the package, for
                         ``repairs.explain`` makes an ExpressionError of it
    Note                 no error: a text was read, but others might read it otherwise

Spans are [from, to) in the text that the student typed.
"""

from dataclasses import dataclass
from typing import Any, Final, Literal

Span = tuple[int, int]

# A message is short.
_LONGEST_QUOTATION: Final = 40

Cause = Literal[
    "ambiguous_number", "ambiguous_shorthand", "ambiguous_star", "ambiguous_unit", "argument",
    "arguments", "beyond", "boolean", "character", "command", "cube_root", "degrees", "empty",
    "function_power", "grammar", "index", "invalid_shorthand", "invisible", "look_alike",
    "mismatch", "mixed_number", "name", "not_finite", "plus_minus", "raised_zero", "subscript",
    "transpose", "two_units", "unclosed", "unit_on_variable", "values",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Note:
    """A remark on how a text was read; ``code`` is stable."""

    code: str
    message: str
    span: Span


class TextError(Exception):
    """A text that cannot be read. ``code`` is stable, so that a class can be counted."""

    def __init__(self, code: str, message: str, span: Span, *details: object) -> None:
        super().__init__(code, message, span, *details)
        self.code = code
        self.message = message
        self.span = span

    def __str__(self) -> str:
        return self.message


class ExpressionError(TextError):
    """A formula that cannot be read.

    ``suggestion`` is the whole repaired text where one is near, else None; ``tried`` counts the
    symbols of all texts that were read in search of it.
    """

    def __init__(self, code: str, message: str, span: Span, suggestion: str | None = None) -> None:
        super().__init__(code, message, span, suggestion)
        self.suggestion = suggestion
        self.tried = 0

    def again(self) -> "ExpressionError":
        """An equal error without a traceback, so that a remembered one can be raised."""
        error = ExpressionError(self.code, self.message, self.span, self.suggestion)
        error.tried = self.tried
        return error


class UnreadableError(Exception):
    """The place where the reader stopped.

    ``cause`` names what the reader found there, ``details`` holds what the repairs of that cause
    need besides.
    """

    def __init__(self, cause: Cause, span: Span, **details: Any) -> None:
        super().__init__(cause, span, details)
        self.cause = cause
        self.span = span
        self.details = details


def shortened(text: str) -> str:
    """``text``, or the beginning of a long one."""
    return text if len(text) <= _LONGEST_QUOTATION else f"{text[:_LONGEST_QUOTATION]}…"


def counted(values: int) -> str:
    """A number of values in words."""
    return "one value" if values == 1 else f"{values} values"


def quoted(text: str) -> str:
    """``text`` as a message quotes it: shortened, and with the numbers of unprintable letters."""
    text = shortened(text)
    if all(letter.isprintable() for letter in text):
        return f"`{text}`"
    return " ".join(f"U+{ord(letter):04X}" for letter in text)
