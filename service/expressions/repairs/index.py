"""Indices in brackets that name no symbol (q[6] with six joints) or have mixed styles."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.regex import regex
from service.translations import say

# A whole number in brackets; then the name before it is unknown, not the index.
_NUMBERED = regex(r"\[\s{0,8}\d+\s{0,8}\]")


@for_causes("index", "name")
def repair_index(failure: Failure) -> Repair:
    """Say how the index is counted, and suggest the name without brackets."""
    if failure.cause == "name":
        return _no_number(failure)
    details, written = failure.details, quoted(failure.written)
    if details["reason"] == "mixed":
        message = say("Two ways to count joints are mixed here. Write each index without brackets.")
        return error(failure, "mixed_index", message)
    if details["reason"] == "no_stem":
        message = say(
            "{written} may be an index or a factor. Write * before a factor.", written=written
        )
        return error(failure, "index", message, failure.replaced(f"*{details['digits']}"))
    run, digits = details["run"], details["digits"]
    if details["reason"] == "shorthand" and run == "S":
        message = say(
            "{written} is a number in SymPy, and may be a sine. Write {number} or s{number}.",
            written=written,
            number=digits,
        )
        return error(failure, "index", message)
    name = f"{run}{digits}"
    if details["reason"] == "shorthand":
        return error(failure, "index", _of_shorthand(failure, name), failure.replaced(name))
    if details["style"] == "(":
        message = say(
            "MATLAB counts from 1, so {written} would be {name}, which is no name here. "
            "Write the index without brackets.",
            written=written,
            name=name,
        )
        return error(failure, "index", message)
    plain = f"{run}{int(digits) - 1}"
    message = say(
        "Python counts from 0, so {written} would be {name}, which is no name here. "
        "If you mean {meant}, write it without brackets.",
        written=written,
        name=name,
        meant=plain,
    )
    return error(failure, "index", message, failure.replaced(plain))


def _of_shorthand(failure: Failure, name: str) -> str:
    """Return a sentence about a shorthand whose index is in brackets: c[1], s(2)."""
    written = quoted(failure.written)
    if failure.details["style"] == "[":
        return say(
            "Python counts from 0, so {written} would be {name}. "
            "Write the shorthand without brackets.",
            written=written,
            name=name,
        )
    return say(
        "MATLAB counts from 1, so {written} would be {name}. Write the shorthand without brackets.",
        written=written,
        name=name,
    )


def _no_number(failure: Failure) -> Repair:
    """Return the error for an index that is not a whole number: q[i], q[-1]."""
    start, end = failure.span
    if failure.source[end : end + 1] != "[" or _NUMBERED.match(failure.source, end):
        return None
    message = say("An index must be a positive whole number. Write the index without brackets.")
    return error(failure, "index", message, span=(start, end + 1))
