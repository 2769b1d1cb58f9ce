"""A range of values instead of one value: [0, pi], 0 < q1 < pi, -180..180."""

from service.expressions.repairs.failure import Failure, Repair, error
from service.regex import regex
from service.translations import say

_BETWEEN = regex(
    r"[<>≤≥∈]|\.\.+|…|\\(?:leq?|geq?|lt|gt|in)(?![A-Za-z])|\bto\b|(?<=[0-9i])\s*:\s*(?=[-0-9])"
)
_LIST = regex(r"\s*(?:\[[^\[\]()]*,[^\[\]()]*[\])]|\([^\[\]()]*,[^\[\]()]*\])\s*")


def repair_interval(failure: Failure) -> Repair:
    """Ask the student for one value."""
    match = _LIST.fullmatch(failure.source) or _BETWEEN.search(failure.source)
    if match is None:
        return None
    message = say("This is a list or a range. Write one value.")
    return error(failure, "interval", message, span=match.span())
