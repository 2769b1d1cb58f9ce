"""A raised 0 or o behind a number, which was meant as the sign of degrees: 90⁰, 90^o."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Offer the degree sign."""
    start, end = failure.span
    if failure.stop.cause == "name":
        before = failure.source[:start].rstrip("{ ")
        if failure.written not in {"o", "O"} or not before.endswith("^"):
            return None
        start = len(before) - 1
        end += failure.source[end : end + 1] == "}"
    elif failure.stop.cause != "raised_zero":
        return None
    message = "Degrees are written with the sign °, or with deg: 90° or 90deg."
    suggestion = failure.replaced("°", (start, end))
    return ExpressionError("raised_zero", message, (start, end), suggestion)
