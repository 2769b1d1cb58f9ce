"""A text that ends in an operator."""

from service.expressions.errors import ExpressionError
from service.expressions.parsing.lexer import END
from service.expressions.repairs.failure import Failure, quoted, unexpected_token

OPERATORS = frozenset({"PLUS", "MINUS", "STAR", "SLASH", "POWER", "ROOT"})


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the text before it."""
    unexpected = unexpected_token(failure)
    if unexpected is None or unexpected.terminal != END or unexpected.before not in OPERATORS:
        return None
    span = unexpected.span(1)
    return ExpressionError(
        "trailing_operator",
        f"The text ends in {quoted(failure.source[slice(*span)])}; something is missing after it.",
        span,
        failure.source[: span[0]].rstrip() or None,
    )
