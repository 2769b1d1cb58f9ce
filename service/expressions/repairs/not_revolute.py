"""Shorthand with a joint that has no angle: c3 if joint 3 slides, s7 if there is no joint 7."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


@for_causes("invalid_shorthand")
def repair_not_revolute(failure: Failure) -> Repair:
    """Say why the joint has no angle."""
    # There is no suggestion: the exercise may test whether students leave out the joint.
    joint = failure.details["joint"]
    if joint in failure.vocabulary.turning:
        return None
    message = say(
        "{written} is a cosine or sine of joint angles, but there is no joint {joint}.",
        written=quoted(failure.written),
        joint=joint,
    )
    if joint in failure.vocabulary.sliding:
        message = say(
            "{written} is a cosine or sine of joint angles, but joint {joint} slides, so it has no "
            "angle. Only joints that turn add to the angle.",
            written=quoted(failure.written),
            joint=joint,
        )
    return error(failure, "not_revolute", message)
