"""tan2(y, x), which was meant to be atan2."""

import re

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, halt

_TAN2 = re.compile(
    r"\\?(?:tan|tang|a ?tan|atang|artan|arctan|arctang)[ _]?\{?2\}?(?=\s*(?:\\left)?\()"
)


def repair(failure: Failure) -> ExpressionError | None:
    """Offer atan2."""
    stopped = halt(failure)
    match = _TAN2.search(failure.source)
    if match is None or match.end() > failure.span[1]:
        return None
    if failure.stop.cause != "name" and (stopped is None or stopped.terminal != "COMMA"):
        return None
    message = "The angle of a point (x, y) is atan2(y, x)."
    return ExpressionError(
        "tan_of_two", message, match.span(), failure.replaced("atan2", match.span())
    )
