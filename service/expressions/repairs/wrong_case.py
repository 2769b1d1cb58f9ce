"""A known name in the wrong letter case: cOs for cos."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.expressions.repairs.nearest_name import other_case
from service.translations import say


@for_causes("name")
def repair_wrong_case(failure: Failure) -> Repair:
    """Suggest the name as it is declared."""
    known = other_case(failure.details["run"], failure.vocabulary, failure.details["called"])
    if known is None:
        return None
    message = say(
        "{written} is no name here, but {known} is: capital and small letters differ.",
        written=quoted(failure.written),
        known=known,
    )
    return error(failure, "wrong_case", message, failure.replaced(known))
