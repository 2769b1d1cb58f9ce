"""A text that is too long, too large or nested too deep."""

from service.expressions.limits import LIMITS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes


@for_causes("beyond")
def repair(failure: Failure) -> Repair:
    """Name the limit that is exceeded."""
    limit = failure.details["limit"]
    if limit == "characters":
        message = (
            f"This has {failure.details['length']:,} characters. "
            f"A formula may have {LIMITS.characters:,}."
        )
        return error(failure, "too_long", message)
    if limit == "nodes":
        message = f"This has more than {LIMITS.nodes:,} operations and values. Write it shorter."
        return error(failure, "too_many_nodes", message)
    if limit == "terms":
        message = "A sum or a product here is too long. Collect its terms."
        return error(failure, "too_many_nodes", message)
    message = (
        f"More than {LIMITS.depth} brackets, signs or functions stand inside each other. "
        "Write it with fewer."
    )
    return error(failure, "too_deep", message)
