"""The letter x as product sign: 2 x q1."""

from service.expressions.parsing.lexing.tokens import OPERAND_ENDS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("name")
def repair_letter_x(failure: Failure) -> Repair:
    """Suggest * for an x between two values."""
    run, (start, end) = failure.details["run"], failure.span
    after = failure.source[end - len(run) + 1 :].strip()
    if run[0] not in "xX" or not after or failure.details["before"] not in OPERAND_ENDS:
        return None
    message, span = say("The letter x is a name. Write * for a product."), (start, start + 1)
    return error(failure, "letter_x", message, failure.replaced("*", span), span)
