r"""An index that is no index: c_{\theta_1+\theta_2}, θ₁₊₂."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure

_FUNCTIONS = {"c": "cos", "s": "sin", "C": "cos", "S": "sin"}
# In s_{1+2} the digits are joints, in a sum of angles they would be numbers.
_BARE = re.compile(r"(?:^|[^A-Za-z0-9_{])\s*[0-9]")


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for the index alone; offer the cosine where c stands before a sum of angles."""
    if failure.cause != "subscript":
        return None
    start, end = failure.span
    inside = failure.details["index"]
    letter = failure.source[start - 1 : start]
    suggestion = None
    alone = not failure.source[start - 2 : start - 1].isalpha() or start < 2
    if (
        letter in _FUNCTIONS
        and alone
        and not _BARE.search(inside)
        and failure.written.startswith("_")
    ):
        suggestion = failure.replaced(f" {_FUNCTIONS[letter]}({inside})", (start - 1, end)).strip()
    return ExpressionError(
        "subscript",
        "An index holds letters and digits only, for example theta_1 or c_{12}. "
        "Write the cosine of a sum as cos(theta1 + theta2).",
        failure.span,
        suggestion,
    )
