"""2e1, where e1 is a declared symbol."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted


def repair(failure: Failure) -> ExpressionError | None:
    """Name both readings, and offer the product."""
    if failure.cause != "ambiguous_number":
        return None
    product = failure.details["product"]
    return ExpressionError(
        "ambiguous_number",
        f"{quoted(failure.written)} may be a power of ten or a product. "
        f"If it is a product, write {product}.",
        failure.span,
        failure.replaced(product),
    )
