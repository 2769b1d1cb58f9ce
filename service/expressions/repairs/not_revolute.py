"""c3 or s7, where joint 3 slides and joint 7 is not there."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted


@answers("invalid_shorthand")
def repair(failure: Failure) -> Repair:
    """Say why that joint has no angle.

    No repaired text: to leave the joint out is to answer what the exercise asks.
    """
    joint = failure.details["joint"]
    if joint in failure.vocabulary.turning:
        return None
    slides = joint in failure.vocabulary.sliding
    reason = f"joint {joint} slides, so it has no angle" if slides else f"there is no joint {joint}"
    message = f"{quoted(failure.written)} is a cosine or sine of joint angles, but {reason}."
    if slides:
        message += " Only joints that turn add to the angle."
    return error(failure, "not_revolute", message)
