"""A unit after a variable: (q1 + 90)deg. Only numbers have units."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.regex import regex
from service.translations import say

_UNITS = {"°", "deg", "degree", "degrees", "rad", "radian", "radians"}
_IN_DEGREES = {"°", "deg", "degree", "degrees"}
# A number without a unit that is a term by itself.
_TERM = regex(
    r"(?<![\w.^*/°])(?:(?<=^)|(?<=[-+(\[{,;=\s]))((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?![\w.^]))"
    r"(?=\s*(?:[-+)\]},;]|$))"
)
_BRACKETS = regex(r"[(\[{|\\]")


@for_causes("unit_on_variable")
def repair_unit_on_variable(failure: Failure) -> Repair:
    """Ask the student to write the unit after a number."""
    name = quoted(failure.source[slice(*failure.details["variable"])])
    message = say("A unit belongs after a number. Write it there, and not after {name}.", name=name)
    return error(failure, "unit_on_variable", message, _repaired(failure))


def _repaired(failure: Failure) -> str | None:
    # Return the text without the unit if it follows only the variable (q1° -> q1); else None.
    # In 90 + q1°, the unit belongs to the number, so it is moved to the number.
    start, end = failure.span
    inside = failure.details["variable"]
    rest = failure.source[inside[1] : end].strip()
    if inside[0] != start or rest not in _UNITS:
        return None
    before, after = failure.source[: inside[1]], failure.source[end:]
    if rest not in _IN_DEGREES or not (_TERM.search(before) or _TERM.search(after)):
        return before + after
    if _BRACKETS.search(failure.source):
        return None
    unit = "°" if rest == "°" else f" {rest}"
    return _TERM.sub(rf"\g<1>{unit}", before + after)
