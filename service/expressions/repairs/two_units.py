"""90 deg deg, deg(90°)."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Say that one is enough."""
    if failure.cause != "two_units":
        return None
    message = "This has two units; one is enough."
    return ExpressionError("two_units", message, failure.span)
