"""A prime or an apostrophe: a transpose in MATLAB, a derivative or another symbol on paper."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

# What is left out behind a number may be its unit, as the minutes of an angle.
_NUMBER = re.compile(r"(?<![\w.])[0-9.]+\s*$")
_RAISED_T = re.compile(r"\^\s*\{?\s*(?:\\top|T)\s*\}?|\.'")


@answers("transpose", "name", "command", "character")
def repair(failure: Failure) -> Repair:
    """Say that a value has neither, and offer the text without, unless that joins digits."""
    span = failure.span
    if failure.cause != "transpose":
        match = _RAISED_T.search(failure.source)
        if match is None or match.end() < span[0] or match.start() > span[1]:
            return None
        span = match.span()
    mark = quoted(failure.source[slice(*span)].strip())
    message = f"A single value has no transpose and no derivative here. Leave out {mark}."
    before, behind = failure.source[: span[0]], failure.source[span[1] :]
    if _NUMBER.search(before) or (before[-1:].isdigit() and behind[:1].isdigit()):
        return error(failure, "transpose", message, None, span)
    return error(failure, "transpose", message, (before + behind).strip() or None, span)
