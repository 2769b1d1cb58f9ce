"""The letters e, i and j, which are not constants in a formula."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, undeclared
from service.regex import regex
from service.translations import paragraph, say

_REASONS = {
    "e": say("Write a power of Euler's number as exp(x)."),
    "i": say("There are no complex numbers here."),
    "j": say("There are no complex numbers here."),
}
_POWER = regex(r"\s?(?:\^|\*\*)\s?(?:\(([^()]*)\)|\{([^{}]*)\}|([A-Za-z0-9]+))")


@for_causes("name")
def repair_euler_and_imaginary(failure: Failure) -> Repair:
    """Suggest exp(x) for a power of e; for i and j, say that there are no complex numbers."""
    reason = _REASONS.get(failure.details["run"])
    if reason is None:
        return None
    message = paragraph(undeclared(failure), reason)
    (start, end), suggestion = failure.span, None
    power = _POWER.match(failure.source, end) if failure.details["run"] == "e" else None
    if power is not None:
        exponent = power[power.lastindex or 0]
        suggestion = failure.replaced(f"exp({exponent})", (start, power.end()))
    return error(failure, "unknown_symbol", message, suggestion)
