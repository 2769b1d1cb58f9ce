"""A bracket that is closed by a bracket of another kind: (q1 + q2]."""

import re

from service.expressions.characters.unicode import CLOSE
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, position, quoted

_COMMAND = re.compile(r"\\(?:[dtc]?frac|sqrt)\s{0,8}$")


@for_causes("mismatch")
def repair(failure: Failure) -> Repair:
    """Name both brackets and their places; suggest the closing bracket that fits."""
    opener, wanted = failure.details["opener"], failure.details["wanted"]
    first = quoted(failure.source[slice(*opener)])
    if wanted == CLOSE or failure.span[0] == failure.span[1]:
        message = f"The {first} at {position(opener)} has no closing bracket."
        if command := _COMMAND.search(failure.source, 0, opener[0]):
            message = f"Write braces after `{command[0].rstrip()}`, not {first}."
        return error(failure, "mismatched_bracket", message, span=opener)
    message = (
        f"{first} at {position(opener)} is closed by {quoted(failure.written)} at "
        f"{position(failure.span)}. Use two brackets of one kind."
    )
    return error(failure, "mismatched_bracket", message, failure.replaced(wanted))
