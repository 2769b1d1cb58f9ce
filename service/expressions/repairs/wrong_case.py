"""A known name with other capitals: L1 for l1."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted
from service.expressions.repairs.nearest_name import other_case


@answers("name")
def repair(failure: Failure) -> Repair:
    """Offer the name as it is declared: l1 and L1 are different names."""
    known = other_case(failure.details["run"], failure.vocabulary, failure.details["called"])
    if known is None:
        return None
    message = (
        f"{quoted(failure.written)} is not known, but {known} is: "
        "capital and small letters differ in names."
    )
    return error(failure, "wrong_case", message, failure.replaced(known))
