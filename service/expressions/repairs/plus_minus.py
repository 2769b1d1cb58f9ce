"""± and +/-, which stand for two values."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_TYPED = re.compile(r"\+\s*/\s*-")


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for one of the two."""
    if failure.cause == "plus_minus":
        span = failure.span
    elif failure.cause == "grammar" and (match := _TYPED.search(failure.source)):
        span = match.span()
    else:
        return None
    message = "This sign stands for two values; write the one that you mean, with + or with -."
    return ExpressionError("two_values", message, span)
