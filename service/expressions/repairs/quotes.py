"""Names in quotation marks, or declared as in a program: 'q1', Symbol('q1')."""

import re

from service.expressions.repairs.failure import Failure, Repair, error
from service.regex import regex
from service.translations import say

_QUOTED = regex(
    r"(?:\b(?:\w+\.)?(?:Symbol|symbols|sym|var|syms)\(\s*)?([\"'“”‘’])([^\"'“”‘’]*)[\"'“”‘’](\s*\))?"
)
# A mark between digits, as in 1’5, does not quote a name.
_BETWEEN_DIGITS = regex(r"[0-9][\"'“”‘’]+[0-9]")


def repair_quotes(failure: Failure) -> Repair:
    """Suggest the text without quotation marks."""
    match = _QUOTED.search(failure.source)
    if match is None or _BETWEEN_DIGITS.search(failure.source):
        return None
    suggestion = _QUOTED.sub(_inside, failure.source).strip()
    message = say("Write names without quotation marks.")
    return error(failure, "quotes", message, suggestion or None, match.span())


def _inside(found: re.Match[str]) -> str:
    called = "(" in found.group()[: found.start(1) - found.start()]
    return found[2] if called or found[3] is None else found[2] + found[3]
