r"""Units after a length: 0.5 m, 30cm, \SI{0.5}{\metre}."""

import unicodedata

from service.expressions.errors import Span
from service.expressions.parsing.lexing.tokens import OPERAND_ENDS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_UNIT = regex(
    r"(?:k|c|m|d|µ|μ)?m|in|inch|inches|ft|foot|feet|(?:centi|milli)?met(?:er|re)s?|[°]?C|kg|s|N"
)
_METRES = frozenset({"m", "meter", "meters", "metre", "metres"})
_QUANTITY = regex(r"\\[A-Za-z]{2,3}\s{0,4}\{([^{}]*)\}\s{0,4}\{\s{0,4}\\?([^{}]*?)\s{0,4}\}")
# In l2 s(q1), s is the sine and not the second.
_FUNCTIONS = frozenset({"s", "C"})
_OPERANDS = OPERAND_ENDS - {"UNIT"}
_OPENING = regex(r"(?<=[\w.)}])\s{0,4}[(\[]\s{0,4}\Z")
_CLOSING = regex(r"\s{0,4}[)\]]")
_WITHOUT_UNIT = say("Write lengths without a unit, in the unit of the exercise.")


@for_causes("name", "quantity")
def repair_length_unit(failure: Failure) -> Repair:
    """Ask for a number without a unit; suggest this number if the unit is metres."""
    if failure.cause == "quantity":
        return _quantity(failure)
    written = unicodedata.normalize("NFKC", failure.written)
    brackets = _brackets(failure)
    is_after_value = failure.details["before"] in _OPERANDS or brackets != failure.span
    if not is_after_value or not _UNIT.fullmatch(written):
        return None
    if failure.details["called"] and failure.written in _FUNCTIONS:
        return None
    if written not in _METRES:
        message = say(
            "Write lengths without a unit, in the unit of the exercise. Convert {unit} first.",
            unit=written,
        )
        return error(failure, "length_unit", message)
    start, end = brackets
    number = failure.source[:start].rstrip() + failure.source[end:]
    return error(failure, "length_unit", _WITHOUT_UNIT, number)


def _brackets(failure: Failure) -> Span:
    start, end = failure.span
    opening = _OPENING.search(failure.source, 0, start)
    closing = _CLOSING.match(failure.source, end)
    return (opening.start(), closing.end()) if opening and closing else failure.span


def _quantity(failure: Failure) -> Repair:
    quantity = _QUANTITY.fullmatch(failure.written)
    if quantity is None or quantity[2] not in _METRES:
        message = say(
            "Write lengths without a unit, in the unit of the exercise. Convert this one first."
        )
        return error(failure, "length_unit", message)
    return error(failure, "length_unit", _WITHOUT_UNIT, failure.replaced(quantity[1]))
