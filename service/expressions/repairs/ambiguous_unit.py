"""A unit before a bracket: 2deg(q1), degrees(90)."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("ambiguous_unit")
def repair(failure: Failure) -> Repair:
    """Ask for the unit after the number."""
    if not failure.details["opens"]:
        return None
    message = say(
        "A unit before a bracket has two readings. Write an operator between them, "
        "as in 2deg*(3), or the unit after the bracket, as in (180/2)deg."
    )
    return error(failure, "ambiguous_unit", message)
