"""A comment after the expression: % in MATLAB and LaTeX, # in Python, // and /* in C."""

from service.expressions.repairs.failure import Failure, Repair, error
from service.regex import regex
from service.translations import say

_COMMENT = regex(r"(?<!\\)%|#|//|/\*|\(\*")
# A word of prose.
_WORD = regex(r"(?!(?:deg|rad|sin|cos|tan)\b)[^\W\d_]{3,}")
_OPERATOR = regex(r"[-+*/^=(,]")


def repair_comment(failure: Failure) -> Repair:
    """Suggest the text without the comment, or one slash instead of two."""
    match = _COMMENT.search(failure.source)
    if match is None:
        return None
    before, after = failure.source[: match.start()].rstrip(), failure.source[match.end() :].strip()
    if not before or (match.group() == "%" and not after):
        return None
    division = f"{before}/{after}"
    if match.group() == "//" and failure.repaired(division) == division:
        message = say(
            "// is a comment in some languages and a whole-number division in others. "
            "For a fraction, write one slash."
        )
        return error(failure, "comment", message, division, match.span())
    span = match.start(), len(failure.source)
    # The text after the sign seems to be part of the formula, not a comment.
    if not _WORD.search(after) or _OPERATOR.match(after) or _OPERATOR.match(before[-1:]):
        before = ""
    message = say(
        "The text after {sign} looks like a comment. Write only the formula.", sign=match.group()
    )
    return error(failure, "comment", message, before or None, span)
