"""A dash alone, which tables print for an empty cell or for zero."""

from service.expressions.repairs.failure import Failure, Repair, error
from service.regex import regex
from service.translations import say

_DASH = regex(r"[-–—−‐‑‒―]+")


def repair_dash(failure: Failure) -> Repair:
    """Suggest 0, and say that a dash may mean zero or nothing."""
    if _DASH.fullmatch(failure.source.strip()) is None:
        return None
    message = say("A dash may mean zero or nothing. If the value is zero, write 0.")
    return error(failure, "dash", message, "0", (0, len(failure.source)))
