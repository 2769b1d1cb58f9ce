"""acosd and rad2deg, which return degrees, if angles are in radians."""

import re

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.expressions.vocabulary.functions import IN_DEGREES

_MODULE = re.compile(r"[A-Za-z]+\.$")


@for_causes("degrees")
def repair(failure: Failure) -> Repair:
    """Suggest the function that returns the angle in radians: acos for acosd."""
    plain = IN_DEGREES.get(failure.details["name"], "")
    advice = f"Write {plain}, which gives the angle." if plain else "Write the angle itself."
    start, end = failure.span
    if not plain and (module := _MODULE.search(failure.source[:start])):
        start = module.start()
    message = f"{quoted(failure.written)} gives a number of degrees, not an angle. {advice}"
    return error(failure, "degrees_function", message, failure.replaced(plain, (start, end)))
