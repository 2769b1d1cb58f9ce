"""Units behind a length: 0.5 m, 30cm."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.parsing.lexer import OPERAND_ENDS
from service.expressions.repairs.failure import Failure

_UNIT = re.compile(
    r"(?:k|c|m|d|µ|μ)?m|in|inch|inches|ft|foot|feet|(?:centi|milli)?met(?:er|re)s?|[°]?C|kg|s|N"
)
_OPERANDS = OPERAND_ENDS - {"UNIT"}


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for the bare number; offer it for metres only, for cm and mm change its size."""
    if failure.cause != "name" or failure.details["before"] not in _OPERANDS:
        return None
    if _UNIT.fullmatch(failure.written) is None:
        return None
    metres = failure.written in {"m", "meter", "meters", "metre", "metres"}
    message = "Lengths are written without a unit, in the unit that the exercise gives."
    if not metres:
        message += f" Convert from {failure.written} first."
    start, end = failure.span
    suggestion = f"{failure.source[:start].rstrip()}{failure.source[end:]}" if metres else None
    return ExpressionError("length_unit", message, failure.span, suggestion)
