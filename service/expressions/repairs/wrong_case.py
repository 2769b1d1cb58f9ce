"""A known name in the wrong letter case: cOs for cos."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.expressions.repairs.nearest_name import other_case


@for_causes("name")
def repair(failure: Failure) -> Repair:
    """Suggest the name as it is declared."""
    known = other_case(failure.details["run"], failure.vocabulary, failure.details["called"])
    if known is None:
        return None
    message = (
        f"{quoted(failure.written)} is no name here, but {known} is: "
        "capital and small letters differ."
    )
    return error(failure, "wrong_case", message, failure.replaced(known))
