"""NaN, infinity, or a number too large for the machine."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Say that every answer is a finite number."""
    if failure.cause != "not_finite":
        return None
    message = "This is not a finite number; every answer here is one."
    return ExpressionError("not_finite", message, failure.span)
