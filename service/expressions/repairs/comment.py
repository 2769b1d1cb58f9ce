"""A comment behind the expression: % in MATLAB and LaTeX, # in Python, // and /* in C."""

import re

from service.expressions.repairs.failure import Failure, Repair, error

_COMMENT = re.compile(r"(?<!\\)%|#|//|/\*|\(\*")


def repair(failure: Failure) -> Repair:
    """Offer the text before the comment, or one slash where // was a division."""
    match = _COMMENT.search(failure.source)
    if match is None:
        return None
    before, behind = failure.source[: match.start()].rstrip(), failure.source[match.end() :].strip()
    if not before or (match.group() == "%" and not behind):
        return None
    division = f"{before}/{behind}"
    if match.group() == "//" and failure.repaired(division) == division:
        message = (
            "// begins a comment in some languages and drops the remainder in Python. "
            "If this is a division, write one slash."
        )
        return error(failure, "comment", message, division, match.span())
    message = f"From {match.group()} on this looks like a comment; write only the expression."
    return error(failure, "comment", message, before, (match.start(), len(failure.source)))
