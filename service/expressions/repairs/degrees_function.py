"""Functions such as acosd and rad2deg, which return degrees, in a text with radians."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.expressions.vocabulary.functions import IN_DEGREES
from service.regex import regex
from service.translations import say

_MODULE = regex(r"[A-Za-z]+\.$")


@for_causes("degrees")
def repair_degrees_function(failure: Failure) -> Repair:
    """Suggest the function that returns the angle in radians: acos for acosd."""
    plain = IN_DEGREES.get(failure.details["name"], "")
    start, end = failure.span
    if not plain and (module := _MODULE.search(failure.source[:start])):
        start = module.start()
    written = quoted(failure.written)
    message = say(
        "{written} gives a number of degrees, not an angle. Write the angle itself.",
        written=written,
    )
    if plain:
        message = say(
            "{written} gives a number of degrees, not an angle. "
            "Write {function}, which gives the angle.",
            written=written,
            function=plain,
        )
    return error(failure, "degrees_function", message, failure.replaced(plain, (start, end)))
