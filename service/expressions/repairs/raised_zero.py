"""A raised 0 or o as degree sign: 90⁰, 90^0, 90^o."""

from service.expressions.errors import Span
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_LETTER = "[oO]"
_STYLED = rf"(?:\\[a-z]+\s*\{{\s*{_LETTER}\s*\}}|{_LETTER})"
# The second form, 90o, comes from copying a raised sign as plain text.
_RAISED = regex(rf"\^\s*(?:\{{\s*{_STYLED}\s*\}}|{_STYLED})|(?<=[0-9])\s*o")


@for_causes("raised_zero", "name")
def repair_raised_zero(failure: Failure) -> Repair:
    """Suggest the degree sign, or explain that 90^0 may also be a power."""
    span = _raised_letter(failure) if failure.cause == "name" else failure.span
    if span is None:
        return None
    message = say("Write degrees as 90° or 90deg.")
    if failure.details.get("power"):
        message = say(
            "A raised 0 looks like the sign of degrees. Write 90° or 90deg for degrees, "
            "and 1 for the power."
        )
    return error(failure, "raised_zero", message, failure.replaced("°", span), span)


def _raised_letter(failure: Failure) -> Span | None:
    if failure.written not in {"o", "O"}:
        return None
    start, end = failure.span
    matches = (match.span() for match in _RAISED.finditer(failure.source))
    return next((place for place in matches if place[0] <= start and end <= place[1]), None)
