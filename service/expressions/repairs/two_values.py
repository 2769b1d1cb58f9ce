"""Two values in place of one: 2 3, q1, q2, a second line."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, unexpected_token


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for one value, or for an operator between them."""
    unexpected = unexpected_token(failure)
    span = failure.span
    if unexpected is not None:
        after_value = unexpected.terminal != "COMMA" and unexpected.index
        span = (unexpected.span(1)[0], span[1]) if after_value else span
    elif failure.cause != "values":
        return None
    return ExpressionError(
        "two_values",
        "Two values stand side by side here. Write one value, or put an operator "
        "such as * between them.",
        span,
    )
