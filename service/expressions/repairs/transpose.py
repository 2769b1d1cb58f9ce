"""A prime or an apostrophe: a transpose in MATLAB, a derivative or another symbol on paper."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_RAISED_T = re.compile(r"\^\s*\{?\s*(?:\\top|T)\s*\}?|\.'")


def repair(failure: Failure) -> ExpressionError | None:
    """Say that a value has neither, and offer the text without."""
    if failure.cause == "transpose":
        span = failure.span
    elif failure.cause in {"name", "command", "character"} and (
        match := _RAISED_T.search(failure.source)
    ):
        if match.end() < failure.span[0] or match.start() > failure.span[1]:
            return None
        span = match.span()
    else:
        return None
    return ExpressionError(
        "transpose",
        "A prime or a transpose has no meaning for a single value here. "
        "If it marks another symbol, use the name that the exercise gives.",
        span,
        failure.replaced("", span).strip() or None,
    )
