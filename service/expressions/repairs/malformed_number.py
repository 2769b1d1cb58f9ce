"""A number with two points: 1.2.3."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted


@for_causes("values")
def repair(failure: Failure) -> Repair:
    """Say that the number has more than one point."""
    if not failure.details["number"] or "." not in failure.written:
        return None
    message = f"{quoted(failure.written)} has more than one decimal point."
    return error(failure, "malformed_number", message)
