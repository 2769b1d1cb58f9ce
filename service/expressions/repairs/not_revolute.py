"""c3 or s7, where joint 3 slides and joint 7 is not there."""

from unicodedata import digit

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted


@answers("invalid_shorthand")
def repair(failure: Failure) -> Repair:
    """Say why that joint has no angle; offer c12 for c123 where joint 3 alone slides."""
    joint = failure.details["joint"]
    if joint in failure.vocabulary.turning:
        return None
    slides = joint in failure.vocabulary.sliding
    reason = f"joint {joint} slides, so it has no angle" if slides else f"there is no joint {joint}"
    message = f"{quoted(failure.written)} is a cosine or sine of joint angles, but {reason}."
    turning = _of_those_that_turn(failure)
    if turning is None:
        return error(failure, "not_revolute", message)
    message += " Only joints that turn add to the angle."
    return error(failure, "not_revolute", message, failure.replaced(turning))


def _of_those_that_turn(failure: Failure) -> str | None:
    """The shorthand without its sliding joints, if it names some that turn, each once."""
    turning, sliding = failure.vocabulary.turning, failure.vocabulary.sliding
    # Lowered digits count as well: c₁₂₃.
    digits = [digit(letter) for letter in failure.written if letter.isdigit()]
    joints, known = set(digits), failure.vocabulary.joints
    if len(joints) < len(digits) or joints.isdisjoint(turning) or not joints.issubset(known):
        return None
    return "".join(letter for letter in failure.written if digit(letter, -1) not in sliding)
