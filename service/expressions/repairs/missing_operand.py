"""An operator, a unit or brackets without an operand."""

from service.expressions.errors import ExpressionError, Span
from service.expressions.repairs.failure import Failure, UnexpectedToken, quoted, unexpected_token
from service.expressions.repairs.trailing_operator import OPERATORS

_BEFORE_VALUE = OPERATORS | {"LEFT", "OPEN", "COMMA", "TIGHT", "JOIN"}


def repair(failure: Failure) -> ExpressionError | None:
    """Name the place where a value is missing; offer pi for PI()."""
    unexpected = unexpected_token(failure)
    span = failure.span
    suggestion = None
    if unexpected is not None:
        if unexpected.before and unexpected.before not in _BEFORE_VALUE:
            return None
        span = _lacking(unexpected)
        empty = unexpected.before == "LEFT" and unexpected.terminal == "RIGHT"
        if empty and unexpected.index > 2:
            suggestion = failure.replaced("", span)
    elif failure.cause != "ambiguous_unit":
        return None
    return ExpressionError(
        "missing_operand",
        f"Something is missing next to {quoted(failure.source[slice(*span)])}: "
        "a number, a name or a bracket belongs there.",
        span,
        suggestion,
    )


def _lacking(unexpected: UnexpectedToken) -> Span:
    if not unexpected.index:
        return unexpected.span()
    if unexpected.before == "LEFT" and unexpected.terminal == "RIGHT":
        return unexpected.span(1)[0], unexpected.span()[1]
    if unexpected.before in {"LEFT", "COMMA"} and unexpected.terminal in OPERATORS:
        return unexpected.span()
    return unexpected.span(1)
