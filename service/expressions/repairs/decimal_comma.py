"""A comma or an apostrophe as decimal point, or a thousands separator: 1,5; 1’5; 1.000,5."""

import re

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_THOUSANDS = regex(r"(?<![0-9.,])[1-9][0-9]{0,2}(?:,000)+(?![0-9])")
# A number with an apostrophe as decimal mark, and one in which it may separate thousands.
_APOSTROPHE = regex(r"(?<![\w.,'’‘´`′°])[0-9]+(['’‘´`′])[0-9]+(?![0-9.,'’‘´`′])")
_IN_THOUSANDS = regex(r"[1-9][0-9]{0,2}\W[0-9]{3}")
# A number with a thousands separator, and perhaps another sign as decimal point.
_GROUPED = regex(
    r"(?<![\w.,'’])[1-9][0-9]{0,2}(?P<mark>[.,'’ \u00a0\u202f])[0-9]{3}"
    r"(?P<more>(?:(?P=mark)[0-9]{3})*)(?:(?!(?P=mark))[.,](?P<rest>[0-9]+))?"
    r"(?![0-9]|[.,'’][0-9])"
)


@for_causes("grammar", "transpose", "values")
def repair_decimal_comma(failure: Failure) -> Repair:
    """Suggest a decimal point, or explain that 1,000 is ambiguous."""
    if grouped := _grouped(failure):
        return grouped
    if failure.cause == "transpose":
        return _apostrophe(failure)
    start, end = failure.span
    left, right = failure.source[start - 1 : start], failure.source[end : end + 1]
    if failure.terminal() != "COMMA" or not (left.isdigit() and right.isdigit()):
        return None
    if any(match.start() < start < match.end() for match in _THOUSANDS.finditer(failure.source)):
        message = say("A comma separates values. Write a thousand as 1000 and one as 1.")
        return error(failure, "decimal_comma", message)
    message = say("A comma separates values. Write one number with a point.")
    point = re.sub(r"(?<=[0-9]),(?=[0-9])", ".", failure.source)
    return error(failure, "decimal_comma", message, point)


def _grouped(failure: Failure) -> Repair:
    numbers = (each for each in _GROUPED.finditer(failure.source) if _is_sure(each))
    start, end = failure.span
    number = next((each for each in numbers if each.start() <= end and start <= each.end()), None)
    if number is None:
        return None
    typed, rest = number[0], number["rest"]
    whole = typed[: len(typed) - len(rest) - 1] if rest else typed
    plain = re.sub(r"[^0-9]", "", whole) + (f".{rest}" if rest else "")
    message = say(
        "`{typed}` has a thousands separator. Write {number}.",
        # A no-break space looks like a space, but cannot be printed everywhere.
        typed=re.sub(r"\s", " ", typed),
        number=plain,
    )
    repaired = failure.source[: number.start()] + plain + failure.source[number.end() :]
    return error(failure, "decimal_comma", message, repaired, number.span())


def _is_sure(number: re.Match[str]) -> bool:
    # 1.000 is a number, and 1,000 or 1 000 may be two.
    if number["mark"] in "\u00a0\u202f":
        return True
    return bool(number["rest"] or (number["more"] and number["mark"] in ".'’"))


def _apostrophe(failure: Failure) -> Repair:
    numbers = _APOSTROPHE.finditer(failure.source)
    number = next((match for match in numbers if match.span(1) == failure.span), None)
    if number is None:
        return None
    message = say("An apostrophe is no decimal point. Write one number with a point.")
    point = None if _IN_THOUSANDS.fullmatch(number.group()) else failure.replaced(".")
    return error(failure, "decimal_comma", message, point)
