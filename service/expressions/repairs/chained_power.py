"""2^3^2, which has two readings."""

from service.expressions.errors import ExpressionError
from service.expressions.parsing.lexer import OPERAND_ENDS
from service.expressions.repairs.failure import Failure, unexpected_token


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for brackets."""
    unexpected = unexpected_token(failure)
    if (
        unexpected is None
        or unexpected.terminal != "POWER"
        or unexpected.before not in OPERAND_ENDS
    ):
        return None
    return ExpressionError(
        "chained_power",
        "A power of a power has two readings; add brackets, as in (a^b)^c or a^(b^c).",
        failure.span,
    )
