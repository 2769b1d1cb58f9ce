"""Shorthand that names one joint twice: c11."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


@for_causes("invalid_shorthand")
def repair_repeated_joint(failure: Failure) -> Repair:
    """Ask the student to write out the sum."""
    if failure.details["joint"] not in failure.vocabulary.turning:
        return None
    message = say(
        "{written} names one joint twice. Write the sum of the angles, as in cos(2*q1).",
        written=quoted(failure.written),
    )
    return error(failure, "repeated_joint", message)
