"""sin^-1(x), which some read as asin(x) and others as 1/sin(x), and sin^k(x)."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_INVERSE = re.compile(r"(-\s*1|[({]\s*-\s*1\s*[)}])(?![0-9.])")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the inverse function, or ask for brackets with a power."""
    if failure.cause != "function_power":
        return None
    name, exponent = failure.details["name"], failure.details["exponent"]
    place = failure.details["function"]
    if not exponent.strip():
        return ExpressionError(
            "function_without_argument",
            f"The function {name} has nothing to work on; "
            "write its argument in brackets behind it.",
            place,
        )
    if _INVERSE.match(exponent) is None:
        return ExpressionError(
            "function_power",
            "Only a whole number may stand as a function's power; write (sin(x))^p instead.",
            (place[1], failure.span[1]),
        )
    whole = (place[0], _end(failure))
    inverse = f"a{name}" if name in {"sin", "cos", "tan"} else None
    return ExpressionError(
        "function_power",
        "A negative power of a function has two readings. Write asin(x), acos(x) or atan(x) "
        "for the inverse function, or 1/sin(x) for one over it.",
        whole,
        inverse and failure.replaced(inverse, whole),
    )


def _end(failure: Failure) -> int:
    """The end of -1 in the source, however it was raised."""
    match = re.compile(r"[\s^*]*(?:⁻\s*¹|[({]*\s*[-−–]\s*1(?:\s*[)}])*)").match(
        failure.source, failure.details["function"][1]
    )
    return match.end() if match else failure.span[1]
