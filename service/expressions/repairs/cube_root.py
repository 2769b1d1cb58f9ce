r"""∛x and \sqrt[3]{x}: roots other than the square root."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for a power."""
    if failure.cause != "cube_root":
        return None
    message = "Only square roots have a sign here; write other roots as a power, as in (x)^(1/3)."
    return ExpressionError("cube_root", message, failure.span)
