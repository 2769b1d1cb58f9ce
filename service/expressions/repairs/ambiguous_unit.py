"""A unit that is ambiguous: 2deg(q1), degrees(90), π/2°, 180/2°."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("ambiguous_unit")
def repair_ambiguous_unit(failure: Failure) -> Repair:
    """Ask the student to write the unit after a number."""
    if "inside" in failure.details:
        return _inside(failure)
    if not failure.details["opens"]:
        return None
    message = say(
        "A unit before a bracket has two readings. Write an operator between them, "
        "as in 2deg*(3), or the unit after the bracket, as in (180/2)deg."
    )
    return error(failure, "ambiguous_unit", message)


def _inside(failure: Failure) -> Repair:
    (start, end), inside = failure.span, failure.details["inside"]
    value = failure.source[slice(*inside)]
    if failure.details["of_pi"]:
        message = say("With π, a unit of degrees has two readings: π/2 is already 90°.")
        value = value if start == inside[0] else f"({value})"
        return error(failure, "ambiguous_unit", message, failure.replaced(value))
    message = say("A unit after a quotient has two readings. Write brackets, as in (180/2)°.")
    unit = failure.source[inside[1] : end]
    return error(failure, "ambiguous_unit", message, failure.replaced(f"({value}){unit}"))
