"""(q1 + q2]: a bracket closed by one of another kind."""

from service.expressions.characters.unicode import CLOSE
from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, position, quoted


def repair(failure: Failure) -> ExpressionError | None:
    """Name both brackets and their places; offer the partner of the first."""
    if failure.cause != "mismatch":
        return None
    opener, wanted = failure.details["opener"], failure.details["wanted"]
    first = quoted(failure.source[opener[0] : opener[1]])
    if wanted == CLOSE or failure.span[0] == failure.span[1]:
        return ExpressionError("mismatched_bracket", f"{first} is not closed in its place.", opener)
    return ExpressionError(
        "mismatched_bracket",
        f"{first} at {position(opener)} is closed by {quoted(failure.written)} at "
        f"{position(failure.span)}; these two do not belong together.",
        failure.span,
        failure.replaced(wanted),
    )
