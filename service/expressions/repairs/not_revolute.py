"""c3 or s7, where joint 3 slides and joint 7 is not there."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, shown


def repair(failure: Failure) -> ExpressionError | None:
    """Say why that joint has no angle."""
    if failure.stop.cause != "misfit":
        return None
    joint = failure.details["joint"]
    if joint in failure.vocabulary.turning:
        return None
    slides = joint in failure.vocabulary.sliding
    reason = f"joint {joint} slides, so it has no angle" if slides else f"there is no joint {joint}"
    return ExpressionError(
        "not_revolute",
        f"{shown(failure.written)} stands for the cosine or sine of joint angles, but {reason}.",
        failure.span,
    )
