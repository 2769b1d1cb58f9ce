"""A known name with other capitals: L1 for l1."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted
from service.expressions.repairs.nearest_name import other_case


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the name as it is declared: l1 and L1 are different names."""
    if failure.cause != "name":
        return None
    known = other_case(failure.details["run"], failure.vocabulary, failure.details["called"])
    if known is None:
        return None
    return ExpressionError(
        "wrong_case",
        f"{quoted(failure.written)} is not known, but {known} is: "
        "capital and small letters differ in names.",
        failure.span,
        failure.replaced(known),
    )
