"""Quotation marks, and names as programs declare them: 'q1', Symbol('q1')."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_QUOTED = re.compile(
    r"(?:\b(?:\w+\.)?(?:Symbol|symbols|sym|var|syms)\(\s*)?([\"'“”‘’])([^\"'“”‘’]*)[\"'“”‘’](\s*\))?"
)


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the text without them."""
    match = _QUOTED.search(failure.source)
    if match is None or failure.cause == "beyond":
        return None

    def inside(found: re.Match[str]) -> str:
        called = "(" in found.group()[: found.start(1) - found.start()]
        return found[2] if called or found[3] is None else found[2] + found[3]

    message = "Names stand here without quotation marks."
    suggestion = _QUOTED.sub(inside, failure.source).strip()
    return ExpressionError("quotes", message, match.span(), suggestion or None)
