"""acosd and rad2deg, which give degrees, where angles are in radians."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted
from service.expressions.vocabulary.functions import IN_DEGREES

_MODULE = re.compile(r"[A-Za-z]+\.$")


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the function that gives the angle itself."""
    if failure.cause != "degrees":
        return None
    plain = IN_DEGREES.get(failure.details["name"], "")
    advice = f"Write {plain}, which gives the angle." if plain else "Write the angle itself."
    start, end = failure.span
    if not plain and (module := _MODULE.search(failure.source[:start])):
        start = module.start()
    return ExpressionError(
        "degrees_function",
        f"{quoted(failure.written)} gives a number of degrees, not an angle. {advice}",
        failure.span,
        failure.replaced(plain, (start, end)),
    )
