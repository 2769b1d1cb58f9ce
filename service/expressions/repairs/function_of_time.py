"""q1(t): a joint variable as a function of time."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_OF_TIME = regex(r"\s*(?:\\left)?\(\s*t\s*(?:\\right)?\)")


@for_causes("name")
def repair_function_of_time(failure: Failure) -> Repair:
    """Suggest the text without (t)."""
    without_time, count = _OF_TIME.subn("", failure.source)
    if failure.details["run"] != "t" or not count:
        return None
    message = say("Write joint variables without the time: q1, not q1(t).")
    return error(failure, "function_of_time", message, without_time)
