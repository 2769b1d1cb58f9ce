"""A number with two points: 1.2.3."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


@for_causes("values")
def repair_malformed_number(failure: Failure) -> Repair:
    """Say that the number has more than one point."""
    if not failure.details["number"] or "." not in failure.written:
        return None
    message = say("{written} has more than one decimal point.", written=quoted(failure.written))
    return error(failure, "malformed_number", message)
