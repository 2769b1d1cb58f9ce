"""1,5 for 1.5."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error

_THOUSANDS = re.compile(r"(?<![0-9.,])[1-9][0-9]{0,2}(?:,000)+(?![0-9])")


@answers("grammar")
def repair(failure: Failure) -> Repair:
    """Offer a point; for 1,000, which may be a thousand, name both readings."""
    start, end = failure.span
    left, right = failure.source[start - 1 : start], failure.source[end : end + 1]
    if failure.terminal() != "COMMA" or not (left.isdigit() and right.isdigit()):
        return None
    if any(match.start() < start < match.end() for match in _THOUSANDS.finditer(failure.source)):
        message = "A comma separates values. Write a thousand as 1000 and one as 1."
        return error(failure, "decimal_comma", message)
    message = "A comma separates values. Write one number with a point."
    point = re.sub(r"(?<=[0-9]),(?=[0-9])", ".", failure.source)
    return error(failure, "decimal_comma", message, point)
