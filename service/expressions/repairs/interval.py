"""A range of values in place of one value: [0, pi], 0 < q1 < pi, -180..180."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_BETWEEN = re.compile(
    r"[<>≤≥∈]|\.\.+|…|\\(?:leq?|geq?|lt|gt|in)(?![A-Za-z])|\bto\b|(?<=[0-9i])\s*:\s*(?=[-0-9])"
)
_LIST = re.compile(r"\s*(?:\[[^\[\]()]*,[^\[\]()]*[\])]|\([^\[\]()]*,[^\[\]()]*\])\s*")


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for one value."""
    if failure.cause == "beyond":
        return None
    if _LIST.fullmatch(failure.source):
        span = (0, len(failure.source))
    elif match := _BETWEEN.search(failure.source):
        span = match.span()
    else:
        return None
    message = "This looks like a list or a range of values; write the one value that is asked for."
    return ExpressionError("interval", message, span)
