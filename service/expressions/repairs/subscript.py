r"""An index that is no index: c_{\theta_1+\theta_2}, θ₁₊₂."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error

_FUNCTIONS = {"c": "cos", "s": "sin", "C": "cos", "S": "sin"}
# In s_{1+2} the digits are joints, in a sum of angles they would be numbers.
_BARE = re.compile(r"(?:^|[^A-Za-z0-9_{])\s*[0-9]")


@answers("subscript")
def repair(failure: Failure) -> Repair:
    """Ask for the index alone; offer the cosine where c stands before a sum of angles."""
    start, end = failure.span
    inside = failure.details["index"]
    letter = failure.source[start - 1 : start]
    suggestion = None
    alone = not failure.source[start - 2 : start - 1].isalpha() or start < 2
    plain = failure.written.startswith("_") and not _BARE.search(inside)
    if letter in _FUNCTIONS and alone and plain:
        suggestion = failure.replaced(f" {_FUNCTIONS[letter]}({inside})", (start - 1, end)).strip()
    message = (
        "An index holds letters and digits only, as in c_{12}. "
        "Write the cosine of a sum as cos(theta1 + theta2)."
    )
    return error(failure, "subscript", message, suggestion)
