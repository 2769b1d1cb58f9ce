"""(q1 + q2]: a bracket closed by one of another kind."""

from service.expressions.characters.unicode import CLOSE
from service.expressions.repairs.failure import Failure, Repair, answers, error, position, quoted


@answers("mismatch")
def repair(failure: Failure) -> Repair:
    """Name both brackets and their places; offer the partner of the first."""
    opener, wanted = failure.details["opener"], failure.details["wanted"]
    first = quoted(failure.source[slice(*opener)])
    if wanted == CLOSE or failure.span[0] == failure.span[1]:
        message = f"{first} has no closing bracket in its place. Close it, or delete it."
        return error(failure, "mismatched_bracket", message, span=opener)
    message = (
        f"{first} at {position(opener)} is closed by {quoted(failure.written)} at "
        f"{position(failure.span)}. Use two brackets of one kind."
    )
    return error(failure, "mismatched_bracket", message, failure.replaced(wanted))
