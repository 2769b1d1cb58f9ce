"""tan2(y, x) for atan2(y, x)."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, unexpected_token

_TAN2 = re.compile(
    r"\\?(?:tan|tang|a ?tan|atang|artan|arctan|arctang)[ _]?\{?2\}?(?=\s*(?:\\left)?\()"
)


def repair(failure: Failure) -> ExpressionError | None:
    """Offer atan2."""
    unexpected = unexpected_token(failure)
    match = _TAN2.search(failure.source)
    if match is None or match.end() > failure.span[1]:
        return None
    if failure.cause != "name" and (unexpected is None or unexpected.terminal != "COMMA"):
        return None
    message = "The angle of a point (x, y) is atan2(y, x)."
    return ExpressionError(
        "tan_of_two", message, match.span(), failure.replaced("atan2", match.span())
    )
