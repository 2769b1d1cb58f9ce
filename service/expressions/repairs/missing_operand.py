"""An operator, a unit or brackets with nothing to work on."""

from service.expressions.errors import ExpressionError, Span
from service.expressions.repairs.failure import Failure, Halt, halt, shown
from service.expressions.repairs.trailing_operator import OPERATORS

_BEFORE_VALUE = OPERATORS | {"LEFT", "OPEN", "COMMA", "TIGHT", "JOIN"}


def repair(failure: Failure) -> ExpressionError | None:
    """Name what lacks a value; offer pi for PI()."""
    stopped = halt(failure)
    span = failure.span
    suggestion = None
    if stopped is not None:
        if stopped.before and stopped.before not in _BEFORE_VALUE:
            return None
        span = _lacking(stopped)
        empty = stopped.before == "LEFT" and stopped.terminal == "RIGHT"
        if empty and stopped.index > 2:
            suggestion = failure.replaced("", span)
    elif failure.stop.cause != "ambiguous_unit":
        return None
    return ExpressionError(
        "missing_operand",
        f"Something is missing next to {shown(failure.source[slice(*span)])}: "
        "a number, a name or a bracket belongs there.",
        span,
        suggestion,
    )


def _lacking(stopped: Halt) -> Span:
    if not stopped.index:
        return stopped.span()
    if stopped.before == "LEFT" and stopped.terminal == "RIGHT":
        return stopped.span(1)[0], stopped.span()[1]
    if stopped.before in {"LEFT", "COMMA"} and stopped.terminal in OPERATORS:
        return stopped.span()
    return stopped.span(1)
