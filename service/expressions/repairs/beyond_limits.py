"""A text too long, too large or nested too deep to be read."""

from service.expressions.limits import LIMITS
from service.expressions.repairs.failure import Failure, Repair, answers, error


@answers("beyond")
def repair(failure: Failure) -> Repair:
    """Name the limit."""
    limit = failure.details["limit"]
    if limit == "characters":
        message = (
            f"This has {failure.details['length']} characters; "
            f"an expression may have {LIMITS.characters}."
        )
        return error(failure, "too_long", message)
    if limit == "nodes":
        message = (
            f"This has more than {LIMITS.nodes} operations and operands; please write it shorter."
        )
        return error(failure, "too_many_nodes", message)
    message = f"This is nested more than {LIMITS.depth} levels deep; please flatten it."
    return error(failure, "too_deep", message)
