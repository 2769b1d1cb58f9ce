"""An equation where a value is asked for: theta1 = q1, =COS(q1)."""

import re

from service.expressions.repairs.failure import Failure, Repair, error

_EQUALS = re.compile(r":=|&?=+|≈|≡|≔|\\(?:approx|equiv|coloneqq)(?![A-Za-z])")


def repair(failure: Failure) -> Repair:
    """Offer the right-hand side."""
    signs = list(_EQUALS.finditer(failure.source))
    if not signs:
        return None
    right = failure.source[signs[-1].end() :].strip()
    left = failure.source[: signs[0].start()].strip()
    message = "This is an equation; write only the value, without the = sign."
    if not left:
        message = "Write the value without the = sign before it."
    return error(failure, "equation", message, right or left or None, signs[0].span())
