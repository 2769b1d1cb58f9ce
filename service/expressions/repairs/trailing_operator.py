"""A text that ends in an operator."""

from service.expressions.errors import ExpressionError
from service.expressions.parsing.lexer import END
from service.expressions.repairs.failure import Failure, halt, shown

OPERATORS = frozenset({"PLUS", "MINUS", "STAR", "SLASH", "POWER", "ROOT"})


def repair(failure: Failure) -> ExpressionError | None:
    """Offer what stands before it."""
    stopped = halt(failure)
    if stopped is None or stopped.terminal != END or stopped.before not in OPERATORS:
        return None
    span = stopped.span(1)
    return ExpressionError(
        "trailing_operator",
        f"The text ends in {shown(failure.source[slice(*span)])}; something is missing after it.",
        span,
        failure.source[: span[0]].rstrip() or None,
    )
