r"""Units after a length: 0.5 m, 30cm, \SI{0.5}{\metre}."""

import re

from service.expressions.parsing.lexing.tokens import OPERAND_ENDS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say

_UNIT = re.compile(
    r"(?:k|c|m|d|µ|μ)?m|in|inch|inches|ft|foot|feet|(?:centi|milli)?met(?:er|re)s?|[°]?C|kg|s|N"
)
_METRES = frozenset({"m", "meter", "meters", "metre", "metres"})
_QUANTITY = re.compile(r"\\[A-Za-z]{2,3}\s{0,4}\{([^{}]*)\}\s{0,4}\{\s{0,4}\\?([^{}]*?)\s{0,4}\}")
# In l2 s(q1), s is the sine and not the second.
_FUNCTIONS = frozenset({"s", "C"})
_OPERANDS = OPERAND_ENDS - {"UNIT"}
_WITHOUT_UNIT = say("Write lengths without a unit, in the unit of the exercise.")


@for_causes("name", "quantity")
def repair(failure: Failure) -> Repair:
    """Ask for the bare number. Suggest it only for metres, because cm and mm change its value."""
    if failure.cause == "quantity":
        return _quantity(failure)
    if failure.details["before"] not in _OPERANDS or not _UNIT.fullmatch(failure.written):
        return None
    if failure.details["called"] and failure.written in _FUNCTIONS:
        return None
    if failure.written not in _METRES:
        message = say(
            "Write lengths without a unit, in the unit of the exercise. Convert {unit} first.",
            unit=failure.written,
        )
        return error(failure, "length_unit", message)
    start, end = failure.span
    number = failure.source[:start].rstrip() + failure.source[end:]
    return error(failure, "length_unit", _WITHOUT_UNIT, number)


def _quantity(failure: Failure) -> Repair:
    quantity = _QUANTITY.fullmatch(failure.written)
    if quantity is None or quantity[2] not in _METRES:
        message = say(
            "Write lengths without a unit, in the unit of the exercise. Convert this one first."
        )
        return error(failure, "length_unit", message)
    return error(failure, "length_unit", _WITHOUT_UNIT, failure.replaced(quantity[1]))
