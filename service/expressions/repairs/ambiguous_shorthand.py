"""sin45, the sine of a number or of joint angles."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

_GOES_ON = re.compile(r"\.?\w+")


@answers("ambiguous_shorthand")
def repair(failure: Failure) -> Repair:
    """Name both readings, and offer the joint angles."""
    function, names = failure.details["function"], failure.details["names"]
    digits = "".join(letter for letter in failure.written if letter.isdigit())
    message = (
        f"{quoted(failure.written)} has two readings. Write {function}({names}) for the "
        f"joint angles or {function}({digits}) for the number."
    )
    suggestion = _suggestion(failure, f"{function}({names})", f"{function}({digits}")
    return error(failure, "ambiguous_shorthand", message, suggestion)


def _suggestion(failure: Failure, of_joints: str, of_number: str) -> str | None:
    """The text with sin(2q1) for sin2q1, sin(12.5) for sin12.5; None for cos12(q1)."""
    start, end = failure.span
    if failure.source[end : end + 1] in {"(", "[", "{"}:
        return None
    match = _GOES_ON.match(failure.source, end)
    if match is None:
        return failure.replaced(of_joints)
    return failure.replaced(f"{of_number}{match.group()})", (start, match.end()))
