"""Where reading stopped: what the reader saw, before a repair rule puts it into words."""

from typing import Any, Literal

from service.expressions.errors import Span

Cause = Literal[
    "ambiguous_number",
    "ambiguous_shorthand",
    "ambiguous_unit",
    "argument",
    "arguments",
    "beyond",
    "boolean",
    "character",
    "command",
    "cube_root",
    "degrees",
    "dots",
    "empty",
    "function_power",
    "grammar",
    "index",
    "invisible",
    "look_alike",
    "mismatch",
    "misfit",
    "mixed_number",
    "name",
    "not_finite",
    "plus_minus",
    "raised_zero",
    "subscript",
    "transpose",
    "two_units",
    "unclosed",
    "unit_on_variable",
    "values",
]


class UnreadableError(Exception):
    """Reading cannot go on.

    `cause` names what was seen, `span` is [from, to) in the text as typed, `details` holds what
    the rules for that cause need besides.
    """

    def __init__(self, cause: Cause, span: Span, **details: Any) -> None:
        super().__init__(cause, span, details)
        self.cause = cause
        self.span = span
        self.details = details
