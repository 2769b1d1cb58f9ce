"""A text that is too long, too large or nested too deep."""

from service.expressions.limits import LIMITS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("beyond")
def repair_beyond_limits(failure: Failure) -> Repair:
    """Name the limit that is exceeded."""
    limit = failure.details["limit"]
    if limit == "characters":
        message = say(
            "This has {number:,} characters. A formula may have {most:,}.",
            number=failure.details["length"],
            most=LIMITS.characters,
        )
        return error(failure, "too_long", message)
    if limit == "nodes":
        message = say(
            "This has more than {most:,} operations and values. Write it shorter.",
            most=LIMITS.nodes,
        )
        return error(failure, "too_many_nodes", message)
    if limit == "terms":
        message = say("A sum or a product here is too long. Collect its terms.")
        return error(failure, "too_many_nodes", message)
    message = say(
        "More than {most} brackets, signs or functions stand inside each other. "
        "Write it with fewer.",
        most=LIMITS.depth,
    )
    return error(failure, "too_deep", message)
