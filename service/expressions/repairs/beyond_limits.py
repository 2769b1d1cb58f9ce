"""A text too long, too large or nested too deep to be read."""

from service.expressions.errors import ExpressionError
from service.expressions.limits import LIMITS
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Name the limit."""
    if failure.cause != "beyond":
        return None
    limit = failure.details["limit"]
    if limit == "characters":
        return ExpressionError(
            "too_long",
            f"This has {failure.details['length']} characters; "
            f"an expression may have {LIMITS.characters}.",
            failure.span,
        )
    if limit == "nodes":
        return ExpressionError(
            "too_many_nodes",
            f"This has more than {LIMITS.nodes} operations and operands; please write it shorter.",
            failure.span,
        )
    return ExpressionError(
        "too_deep",
        f"This is nested more than {LIMITS.depth} levels deep; please flatten it.",
        failure.span,
    )
