"""A unit of angles in brackets, as in headers: 90 [deg], 1.57 (rad)."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_BRACKETED = regex(r"(?<=[\w.)}])\s{0,4}([(\[])\s{0,4}(°|deg|rad)\s{0,4}[)\]]")


@for_causes("grammar", "ambiguous_unit")
def repair_bracketed_unit(failure: Failure) -> Repair:
    """Suggest the unit without brackets."""
    found = _BRACKETED.search(failure.source)
    if found is None:
        return None
    unit = "°" if found[2] == "°" else f" {found[2]}"
    message = say("Write the unit without brackets.")
    return error(
        failure, "missing_operand", message, failure.replaced(unit, found.span()), found.span()
    )
