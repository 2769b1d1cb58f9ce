"""e, i and j, which are no constants here."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted

_REASONS = {
    "e": "Euler's number is written exp(1), and a power of it exp(x).",
    "i": "Complex numbers are not used here.",
    "j": "Complex numbers are not used here.",
}


def repair(failure: Failure) -> ExpressionError | None:
    """Say how to write Euler's number, and that there are no complex numbers."""
    if failure.cause != "name" or failure.details["run"] not in _REASONS:
        return None
    reason = _REASONS[failure.details["run"]]
    message = f"The name {quoted(failure.written)} is not known in this exercise. {reason}"
    return ExpressionError("unknown_symbol", message, failure.span)
