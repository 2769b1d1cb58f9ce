"""A bracket that is closed by a bracket of another kind: (q1 + q2]."""

from service.expressions.characters.unicode import CLOSE
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.regex import regex
from service.translations import say

_COMMAND = regex(r"\\(?:[dtc]?frac|sqrt)\s{0,8}$")


@for_causes("mismatch")
def repair_mismatched_bracket(failure: Failure) -> Repair:
    """Name both brackets and say where they are. Suggest the closing bracket that fits."""
    opener, wanted = failure.details["opener"], failure.details["wanted"]
    first = quoted(failure.source[slice(*opener)])
    if wanted == CLOSE or failure.span[0] == failure.span[1]:
        message = say(
            "The {bracket} at character {place} has no closing bracket.",
            bracket=first,
            place=opener[0] + 1,
        )
        if command := _COMMAND.search(failure.source, 0, opener[0]):
            message = say(
                "Write braces after `{command}`, not {bracket}.",
                command=command[0].rstrip(),
                bracket=first,
            )
        return error(failure, "mismatched_bracket", message, span=opener)
    message = say(
        "{opening} at character {start} is closed by {closing} at character {end}. "
        "Use two brackets of one kind.",
        opening=first,
        start=opener[0] + 1,
        closing=quoted(failure.written),
        end=failure.span[0] + 1,
    )
    return error(failure, "mismatched_bracket", message, failure.replaced(wanted))
