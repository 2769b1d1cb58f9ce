"""An equation in place of a value: sin(q1) = 0.5, a = b = c."""

from service.expressions.parsing.equation import right_side
from service.expressions.repairs.failure import Failure, Repair, error
from service.regex import regex
from service.translations import say

_EQUALS = regex(r":=|&?=+|≈|≡|≔|\\(?:approx|equiv|coloneqq)(?![A-Za-z])")
_NAME = regex(r"\s*\\?[^\W\d]\w{0,20}\s*")


def repair_equation(failure: Failure) -> Repair:
    """Suggest the right side of the equation if each left side is a name."""
    signs = list(_EQUALS.finditer(failure.source))
    if not signs or right_side(failure.source, failure.vocabulary)[1] is not None:
        return None
    starts = [0, *(sign.end() for sign in signs)]
    left = [failure.source[a : b.start()] for a, b in zip(starts, signs, strict=False)]
    value = failure.source[signs[-1].end() :].strip()
    suggestion = value if all(map(_NAME.fullmatch, left)) else None
    message = say("This is an equation. Write only the value.")
    return error(failure, "equation", message, suggestion or None, signs[0].span())
