"""2^3^2, which has two readings."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, halt


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for brackets."""
    stopped = halt(failure)
    values = {"NUMBER", "NAME", "RIGHT", "CLOSE", "UNIT"}
    if stopped is None or stopped.terminal != "POWER" or stopped.before not in values:
        return None
    return ExpressionError(
        "chained_power",
        "A power of a power has two readings; add brackets, as in (a^b)^c or a^(b^c).",
        failure.span,
    )
