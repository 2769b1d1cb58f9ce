"""c11, which names one joint twice."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted


@answers("invalid_shorthand")
def repair(failure: Failure) -> Repair:
    """Ask for the sum to be written out."""
    if failure.details["joint"] not in failure.vocabulary.turning:
        return None
    message = (
        f"{quoted(failure.written)} names one joint twice. "
        "Write the sum of the angles, as in cos(2*q1)."
    )
    return error(failure, "repeated_joint", message)
