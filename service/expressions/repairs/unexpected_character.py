"""A character that means nothing here."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted


def repair(failure: Failure) -> ExpressionError | None:
    """Name it."""
    return ExpressionError(
        "unexpected_character",
        f"The character {quoted(failure.written)} means nothing in an expression.",
        failure.span,
    )
