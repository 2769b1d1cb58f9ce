"""An operator, a unit or brackets without an operand."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.expressions.repairs.trailing_operator import OPERATORS
from service.translations import say

_BEFORE_VALUE = OPERATORS | {"LEFT", "OPEN", "COMMA", "TIGHT", "JOIN"}


@for_causes("grammar", "ambiguous_unit")
def repair_missing_operand(failure: Failure) -> Repair:
    """Say where a value is missing. Suggest pi for PI()."""
    before, terminal = failure.terminal(1), failure.terminal()
    if before and before not in _BEFORE_VALUE:
        return None
    span, suggestion = failure.span, None
    if before == "LEFT" and terminal == "RIGHT":
        span = failure.place(1)[0], span[1]
        suggestion = failure.replaced("", span) if failure.terminal(3) else None
    elif before and (before not in {"LEFT", "COMMA"} or terminal not in OPERATORS):
        span = failure.place(1)
    message = say(
        "A value is missing next to {written}.", written=quoted(failure.source[slice(*span)])
    )
    return error(failure, "missing_operand", message, suggestion, span)
