"""A comment behind the expression: % in MATLAB and LaTeX, # in Python, // and /* in C."""

import re

from service.expressions.repairs.failure import Failure, Repair, error

_COMMENT = re.compile(r"(?<!\\)%|#|//|/\*|\(\*")
# A word of prose.
_WORD = re.compile(r"(?!(?:deg|rad|sin|cos|tan)\b)[^\W\d_]{3,}")
_OPERATOR = re.compile(r"[-+*/^=(,]")


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
            "// is a comment in some languages and a whole-number division in others. "
            "For a fraction, write one slash."
        )
        return error(failure, "comment", message, division, match.span())
    span = match.start(), len(failure.source)
    # Behind the sign stands no comment, but a part of the formula.
    if not _WORD.search(behind) or _OPERATOR.match(behind) or _OPERATOR.match(before[-1:]):
        before = ""
    message = f"The text after {match.group()} looks like a comment. Write only the formula."
    return error(failure, "comment", message, before or None, span)
