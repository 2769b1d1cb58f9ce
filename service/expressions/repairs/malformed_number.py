"""A number with two points: 1.2.3."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted


def repair(failure: Failure) -> ExpressionError | None:
    """Say that it has more than one point."""
    glued = failure.cause == "values" and failure.details["number"]
    if not glued or "." not in failure.written:
        return None
    message = f"{quoted(failure.written)} is not a number: it has more than one point."
    return ExpressionError("malformed_number", message, failure.span)
