"""A unit before a bracket: 2deg(q1), degrees(90)."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for the unit behind the number."""
    if failure.cause != "ambiguous_unit" or not failure.details["opens"]:
        return None
    return ExpressionError(
        "ambiguous_unit",
        "A unit before a bracket has two readings. Write the unit behind the number: 90deg, "
        "or (180/2)deg.",
        failure.span,
    )
