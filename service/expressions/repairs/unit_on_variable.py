"""(q1 + 90)deg: a variable is not a number of degrees."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

_UNITS = {"°", "deg", "degree", "degrees", "rad", "radian", "radians"}
_IN_DEGREES = {"°", "deg", "degree", "degrees"}
# A number that is a term of its own, without a unit.
_TERM = re.compile(
    r"(?<![\w.^*/°])(?:(?<=^)|(?<=[-+(\[{,;=\s]))((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?![\w.^]))"
    r"(?=\s*(?:[-+)\]},;]|$))"
)
_BRACKETS = re.compile(r"[(\[{|\\]")


@answers("unit_on_variable")
def repair(failure: Failure) -> Repair:
    """Ask for the unit behind the number."""
    name = quoted(failure.source[slice(*failure.details["variable"])])
    message = f"A unit belongs after a number. Write it there, and not after {name}."
    return error(failure, "unit_on_variable", message, _repaired(failure))


def _repaired(failure: Failure) -> str | None:
    """The text without the unit, if that stands behind nothing but the variable: q1° is q1.

    In 90 + q1° the unit is meant for the number as well, and goes there.
    """
    start, end = failure.span
    inside = failure.details["variable"]
    rest = failure.source[inside[1] : end].strip()
    if inside[0] != start or rest not in _UNITS:
        return None
    before, behind = failure.source[: inside[1]], failure.source[end:]
    if rest not in _IN_DEGREES or not (_TERM.search(before) or _TERM.search(behind)):
        return before + behind
    if _BRACKETS.search(failure.source):
        return None
    unit = "°" if rest == "°" else f" {rest}"
    return _TERM.sub(rf"\g<1>{unit}", before + behind)
