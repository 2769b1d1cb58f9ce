"""q1(t): a joint variable as a function of time."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error

_OF_TIME = re.compile(r"\s*(?:\\left)?\(\s*t\s*(?:\\right)?\)")


@answers("name")
def repair(failure: Failure) -> Repair:
    """Offer the names without (t)."""
    without_time, count = _OF_TIME.subn("", failure.source)
    if failure.details["run"] != "t" or not count:
        return None
    message = "Write joint variables without the time: q1, not q1(t)."
    return error(failure, "function_of_time", message, without_time)
