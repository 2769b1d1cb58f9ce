"""e, i and j, which are no constants here."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

_REASONS = {
    "e": "Euler's number is written exp(1), and a power of it exp(x).",
    "i": "Complex numbers are not used here.",
    "j": "Complex numbers are not used here.",
}


@answers("name")
def repair(failure: Failure) -> Repair:
    """Say how to write Euler's number, and that there are no complex numbers."""
    reason = _REASONS.get(failure.details["run"])
    if reason is None:
        return None
    message = f"The name {quoted(failure.written)} is not known in this exercise. {reason}"
    return error(failure, "unknown_symbol", message)
