"""A raised 0 or o behind a number, for the sign of degrees: 90⁰, 90^0, 90^o."""

import re

from service.expressions.errors import ExpressionError, Span
from service.expressions.repairs.failure import Failure

_LETTER = "[oO]"
_STYLED = rf"(?:\\[a-z]+\s*\{{\s*{_LETTER}\s*\}}|{_LETTER})"
# The second form, 90o, comes from copying a raised sign as plain text.
_RAISED = re.compile(rf"\^\s*(?:\{{\s*{_STYLED}\s*\}}|{_STYLED})|(?<=[0-9])\s*o")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the degree sign; 90^0 could be a power as well, so name both."""
    start, end = failure.span
    message = "Degrees are written with the sign °, or with deg: 90° or 90deg."
    if failure.cause == "name":
        raised = _raised_letter(failure)
        if raised is None:
            return None
        start, end = raised
    elif failure.cause != "raised_zero":
        return None
    elif failure.details.get("power"):
        message = (
            "A 0 raised behind a number looks like the sign of degrees. If degrees are meant, "
            "write 90° or 90deg; if it is a power, write 1."
        )
    suggestion = failure.replaced("°", (start, end))
    return ExpressionError("raised_zero", message, (start, end), suggestion)


def _raised_letter(failure: Failure) -> Span | None:
    """The place of the raised o that could not be read, with its brackets."""
    if failure.written not in {"o", "O"}:
        return None
    start, end = failure.span
    matches = (match.span() for match in _RAISED.finditer(failure.source))
    return next((place for place in matches if place[0] <= start and end <= place[1]), None)
