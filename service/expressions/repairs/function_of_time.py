"""q1(t): a joint variable as a function of time."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_OF_TIME = re.compile(r"\s*(?:\\left)?\(\s*t\s*(?:\\right)?\)")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the names without (t)."""
    if failure.cause != "name" or failure.details["run"] != "t":
        return None
    if _OF_TIME.search(failure.source) is None:
        return None
    message = "The joint variables are written without their time here: q1, not q1(t)."
    return ExpressionError(
        "function_of_time", message, failure.span, _OF_TIME.sub("", failure.source)
    )
