"""A prime or an apostrophe: a transpose in MATLAB, a derivative or another symbol on paper."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

_RAISED_T = re.compile(r"\^\s*\{?\s*(?:\\top|T)\s*\}?|\.'")


@answers("transpose", "name", "command", "character")
def repair(failure: Failure) -> Repair:
    """Say that a value has neither, and offer the text without."""
    span = failure.span
    if failure.cause != "transpose":
        match = _RAISED_T.search(failure.source)
        if match is None or match.end() < span[0] or match.start() > span[1]:
            return None
        span = match.span()
    mark = quoted(failure.source[slice(*span)].strip())
    message = f"A single value has no transpose and no derivative here. Leave out {mark}."
    return error(failure, "transpose", message, failure.replaced("", span).strip() or None, span)
