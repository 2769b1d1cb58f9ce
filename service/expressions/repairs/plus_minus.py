"""±, +/- and +-, which mean two values."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.regex import regex
from service.translations import say

_TYPED = regex(r"\+\s*/\s*-")


@for_causes("plus_minus", "grammar")
def repair_plus_minus(failure: Failure) -> Repair:
    """Ask the student for one of the two values."""
    typed = _TYPED.search(failure.source) if failure.cause == "grammar" else None
    if failure.cause == "grammar" and typed is None:
        return None
    message = say("This sign stands for two values. Write one of them, with + or with -.")
    return error(failure, "two_values", message, span=typed and typed.span())
