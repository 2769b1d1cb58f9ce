"""true and false in place of a number."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Say what to write instead."""
    if failure.cause != "boolean":
        return None
    message = "true and false are not numbers; write 1 or 0."
    return ExpressionError("not_a_number", message, failure.span)
