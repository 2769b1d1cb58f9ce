"""Units after a length: 0.5 m, 30cm."""

import re

from service.expressions.parsing.lexing.tokens import OPERAND_ENDS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes

_UNIT = re.compile(
    r"(?:k|c|m|d|µ|μ)?m|in|inch|inches|ft|foot|feet|(?:centi|milli)?met(?:er|re)s?|[°]?C|kg|s|N"
)
_OPERANDS = OPERAND_ENDS - {"UNIT"}


@for_causes("name")
def repair(failure: Failure) -> Repair:
    """Ask for the bare number. Suggest it only for metres, because cm and mm change its value."""
    if failure.details["before"] not in _OPERANDS or not _UNIT.fullmatch(failure.written):
        return None
    message = "Write lengths without a unit, in the unit of the exercise."
    if failure.written not in {"m", "meter", "meters", "metre", "metres"}:
        message += f" Convert {failure.written} first."
        return error(failure, "length_unit", message)
    start, end = failure.span
    number = failure.source[:start].rstrip() + failure.source[end:]
    return error(failure, "length_unit", message, number)
