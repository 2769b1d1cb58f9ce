"""A known name with capitals in odd places: cOs for cos, or a name that two symbols share."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted
from service.expressions.repairs.nearest_name import other_case


@answers("name")
def repair(failure: Failure) -> Repair:
    """Offer the name as it is declared."""
    known = other_case(failure.details["run"], failure.vocabulary, failure.details["called"])
    if known is None:
        return None
    message = (
        f"{quoted(failure.written)} is no name here, but {known} is: "
        "capital and small letters differ."
    )
    return error(failure, "wrong_case", message, failure.replaced(known))
