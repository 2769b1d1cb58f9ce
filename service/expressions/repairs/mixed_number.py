r"""2½ and 2\frac{1}{2}, which are a sum in one notation and a product in the other."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

_NUMBER = re.compile(r"([0-9.]+)\s*$")


@answers("mixed_number")
def repair(failure: Failure) -> Repair:
    """Offer the sum, as such a number is read aloud."""
    fraction = failure.details["fraction"]
    start, end = failure.span
    number = _NUMBER.search(failure.source[:start])
    suggestion = None
    if number is not None:
        total = f"{number[1]} + {fraction}"
        alone = not number.start() and end == len(failure.source.rstrip())
        suggestion = failure.replaced(total if alone else f"({total})", (number.start(), end))
    message = (
        f"A number with {quoted(failure.written)} after it can mean a sum or a product. "
        f"Write it out: + {fraction} or *({fraction})."
    )
    return error(failure, "two_values", message, suggestion)
