"""acosd and rad2deg, which give degrees, where angles are in radians."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted
from service.expressions.vocabulary.functions import IN_DEGREES

_MODULE = re.compile(r"[A-Za-z]+\.$")


@answers("degrees")
def repair(failure: Failure) -> Repair:
    """Offer the function that gives the angle itself."""
    plain = IN_DEGREES.get(failure.details["name"], "")
    advice = f"Write {plain}, which gives the angle." if plain else "Write the angle itself."
    start, end = failure.span
    if not plain and (module := _MODULE.search(failure.source[:start])):
        start = module.start()
    message = f"{quoted(failure.written)} gives a number of degrees, not an angle. {advice}"
    return error(failure, "degrees_function", message, failure.replaced(plain, (start, end)))
