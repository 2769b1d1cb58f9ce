"""An equation where a value is asked for: theta1 = q1, =COS(q1)."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_EQUALS = re.compile(r":=|&?=+|≈|≡|≔|\\(?:approx|equiv|coloneqq)(?![A-Za-z])")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the right-hand side."""
    signs = list(_EQUALS.finditer(failure.source))
    if not signs or failure.cause == "beyond":
        return None
    first, last = signs[0], signs[-1]
    right = failure.source[last.end() :].strip()
    left = failure.source[: first.start()].strip()
    message = "This is an equation; write only the value, without the = sign."
    if not left:
        message = "Write the value without the = sign before it."
    return ExpressionError("equation", message, first.span(), right or left or None)
