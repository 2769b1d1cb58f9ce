"""c11, which names one joint twice."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for the sum to be written out."""
    if (
        failure.cause != "invalid_shorthand"
        or failure.details["joint"] not in failure.vocabulary.turning
    ):
        return None
    return ExpressionError(
        "repeated_joint",
        f"{quoted(failure.written)} names one joint twice. "
        "Write the sum of angles out, for example cos(2*q1).",
        failure.span,
    )
