r"""2½ and 2\frac{1}{2}, which are a sum in one notation and a product in the other."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_NUMBER = re.compile(r"([0-9.]+)\s*$")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the sum, as such a number is read aloud."""
    if failure.cause != "mixed_number":
        return None
    fraction = failure.details["fraction"]
    start, end = failure.span
    number = _NUMBER.search(failure.source[:start])
    suggestion = None
    if number is not None:
        total = f"{number[1]} + {fraction}"
        alone = not number.start() and end == len(failure.source.rstrip())
        whole = total if alone else f"({total})"
        suggestion = failure.replaced(whole, (number.start(), end))
    return ExpressionError(
        "two_values",
        f"A number with {failure.written} behind it can mean a sum or a product. "
        f"Write it out: + {fraction} or *({fraction}).",
        failure.span,
        suggestion,
    )
