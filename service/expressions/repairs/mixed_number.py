r"""A number before a fraction, which may be a sum or a product: 2½, 2\frac{1}{2}."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.regex import regex
from service.translations import say

_NUMBER = regex(r"([0-9.]+)\s*$")


@for_causes("mixed_number")
def repair_mixed_number(failure: Failure) -> Repair:
    """Explain that 2½ may be a sum or a product, and suggest the sum."""
    fraction = failure.details["fraction"]
    start, end = failure.span
    number = _NUMBER.search(failure.source[:start])
    suggestion = None
    if number is not None:
        total = f"{number[1]} + {fraction}"
        alone = not number.start() and end == len(failure.source.rstrip())
        suggestion = failure.replaced(total if alone else f"({total})", (number.start(), end))
    message = say(
        "A number with {written} after it can mean a sum or a product. "
        "Write it out: + {fraction} or *({fraction}).",
        written=quoted(failure.written),
        fraction=fraction,
    )
    return error(failure, "two_values", message, suggestion)
