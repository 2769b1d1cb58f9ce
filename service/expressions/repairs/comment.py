"""A comment behind the expression: % in MATLAB and LaTeX, # in Python, // and /* in C."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_COMMENT = re.compile(r"(?<!\\)%|#|//|/\*|\(\*")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the text before the comment, or one slash where // was a division."""
    match = _COMMENT.search(failure.source)
    if match is None or failure.cause == "beyond":
        return None
    before, behind = failure.source[: match.start()].rstrip(), failure.source[match.end() :].strip()
    if not before or (match.group() == "%" and not behind):
        return None
    span = (match.start(), len(failure.source))
    if match.group() == "//" and failure.repaired(f"{before}/{behind}") == f"{before}/{behind}":
        return ExpressionError(
            "comment",
            "// begins a comment in some languages and drops the remainder in Python. "
            "If this is a division, write one slash.",
            match.span(),
            f"{before}/{behind}",
        )
    return ExpressionError(
        "comment",
        f"From {match.group()} on this looks like a comment; write only the expression.",
        span,
        before,
    )
