"""1,5 for 1.5."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, unexpected_token

_THOUSANDS = re.compile(r"(?<![0-9.,])[1-9][0-9]{0,2}(?:,000)+(?![0-9])")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer a point; for 1,000, which may be a thousand, name both readings."""
    unexpected = unexpected_token(failure)
    if unexpected is None or unexpected.terminal != "COMMA":
        return None
    start, end = failure.span
    if (
        not failure.source[start - 1 : start].isdigit()
        or not failure.source[end : end + 1].isdigit()
    ):
        return None
    message = "A comma separates values here. If this is one number, write it with a point."
    suggestion: str | None = re.sub(r"(?<=[0-9]),(?=[0-9])", ".", failure.source)
    if any(match.start() < start < match.end() for match in _THOUSANDS.finditer(failure.source)):
        message = "A comma separates values here. Write a thousand as 1000, and one as 1."
        suggestion = None
    return ExpressionError("decimal_comma", message, failure.span, suggestion)
