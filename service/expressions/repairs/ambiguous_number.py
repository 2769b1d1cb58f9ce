"""The text 2e1 if e1 is a symbol: it may be a power of ten or a product."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


@for_causes("ambiguous_number")
def repair_ambiguous_number(failure: Failure) -> Repair:
    """Explain that 2e1 is ambiguous, and suggest the product."""
    product = failure.details["product"]
    message = say(
        "{written} may be a power of ten or a product. For the product, write {product}.",
        written=quoted(failure.written),
        product=product,
    )
    return error(failure, "ambiguous_number", message, failure.replaced(product))
