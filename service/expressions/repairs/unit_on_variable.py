"""(q1 + 90)deg: a variable is not a number of degrees."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted


@answers("unit_on_variable")
def repair(failure: Failure) -> Repair:
    """Ask for the unit behind the number."""
    start, end = failure.span
    inside = failure.details["variable"]
    # The unit stands behind nothing but the variable: q1° is the angle q1.
    alone = inside[0] == start and not failure.source[inside[1] : end].strip(" ()")[:1].isdigit()
    rest = failure.source[inside[1] : end].strip()
    suggestion = None
    if alone and rest in {"°", "deg", "degree", "degrees", "rad", "radian", "radians"}:
        suggestion = failure.replaced("", (inside[1], end))
    name = quoted(failure.source[slice(*inside)])
    message = f"A unit belongs after a number. Write it there, and not after {name}."
    return error(failure, "unit_on_variable", message, suggestion)
