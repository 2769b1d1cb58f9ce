"""A prime or an apostrophe: a transpose in MATLAB, a derivative or another symbol on paper."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.regex import regex
from service.translations import say

# A mark after a number may be its unit, such as minutes of an angle, so it must not be removed.
_NUMBER = regex(r"(?<![\w.])[0-9.]+\s*$")
_RAISED_T = regex(r"\^\s*\{?\s*(?:\\top|T)\s*\}?|\.'")


@for_causes("transpose", "name", "command", "character")
def repair_transpose(failure: Failure) -> Repair:
    """Suggest the text without the prime."""
    # There is no suggestion if this would join digits.
    span = failure.span
    if failure.cause != "transpose":
        match = _RAISED_T.search(failure.source)
        if match is None or match.end() < span[0] or match.start() > span[1]:
            return None
        span = match.span()
    mark = quoted(failure.source[slice(*span)].strip())
    message = say(
        "A single value has no transpose and no derivative here. Leave out {mark}.", mark=mark
    )
    before, after = failure.source[: span[0]], failure.source[span[1] :]
    if _NUMBER.search(before) or (before[-1:].isdigit() and after[:1].isdigit()):
        return error(failure, "transpose", message, None, span)
    return error(failure, "transpose", message, (before + after).strip() or None, span)
