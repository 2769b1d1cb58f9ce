"""Two values where one is asked for: 2 3, q1, q2, a second line."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, halt


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for one value, or for an operator between them."""
    stopped = halt(failure)
    span = failure.span
    if stopped is not None:
        after_value = stopped.terminal != "COMMA" and stopped.index
        span = (stopped.span(1)[0], span[1]) if after_value else span
    elif failure.stop.cause != "values":
        return None
    return ExpressionError(
        "two_values",
        "Two values stand side by side here. Write one value, or put an operator "
        "such as * between them.",
        span,
    )
