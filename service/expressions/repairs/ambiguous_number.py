"""2e1, where e1 is a declared symbol."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted


@answers("ambiguous_number")
def repair(failure: Failure) -> Repair:
    """Name both readings, and offer the product."""
    product = failure.details["product"]
    message = (
        f"{quoted(failure.written)} may be a power of ten or a product. "
        f"For the product, write {product}."
    )
    return error(failure, "ambiguous_number", message, failure.replaced(product))
