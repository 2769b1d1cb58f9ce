"""tan2(y, x) instead of atan2(y, x)."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_TAN2 = regex(r"\\?(?:tan|tang|a ?tan|atang|artan|arctan|arctang)[ _]?\{?2\}?(?=\s*(?:\\left)?\()")

_KNOWN = {"atan2", "arctan2", r"\atan2", r"\arctan2"}


@for_causes("name", "grammar")
def repair_tan_of_two(failure: Failure) -> Repair:
    """Suggest atan2."""
    match = _TAN2.search(failure.source)
    if match is None or match.end() > failure.span[1] or match.group() in _KNOWN:
        return None
    if failure.cause == "grammar" and failure.terminal() != "COMMA":
        return None
    message, span = say("Write the angle of a point (x, y) as atan2(y, x)."), match.span()
    return error(failure, "tan_of_two", message, failure.replaced("atan2", span), span)
