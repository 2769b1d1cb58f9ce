"""An empty text."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Say what to write for zero."""
    if failure.cause != "empty":
        return None
    message = "Nothing is written here. If the value is zero, write 0."
    return ExpressionError("empty", message, failure.span)
