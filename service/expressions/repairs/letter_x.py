"""The letter x for a product: 2 x q1."""

from service.expressions.errors import ExpressionError
from service.expressions.parsing.lexer import OPERAND_ENDS
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Offer * where a value stands on either side."""
    if failure.cause != "name" or failure.details["before"] not in OPERAND_ENDS:
        return None
    run, (start, end) = failure.details["run"], failure.span
    if run[0] not in "xX" or not failure.source[end - len(run) + 1 :].strip():
        return None
    return ExpressionError(
        "letter_x",
        "The letter x is a name; for a product write * instead.",
        (start, start + 1),
        failure.replaced("*", (start, start + 1)),
    )
