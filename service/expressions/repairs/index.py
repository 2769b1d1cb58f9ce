"""Indices of programs that name no symbol: q[6] on six joints, or two styles in one text."""

import re

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

# A whole number in brackets: what stands in front of it is the unknown name.
_NUMBERED = re.compile(r"\[\s{0,8}\d+\s{0,8}\]")
_PLAINLY = "Write the index without brackets."
_COUNTING = {"[": "Python counts from 0, so", "(": "MATLAB counts from 1, so"}


@answers("index", "name")
def repair(failure: Failure) -> Repair:
    """Say how it was counted, and offer the plain name."""
    if failure.cause == "name":
        return _no_number(failure)
    details, written = failure.details, quoted(failure.written)
    if details["reason"] == "mixed":
        message = "Two ways to count joints are mixed here. Write each index without brackets."
        return error(failure, "mixed_index", message)
    if details["reason"] == "no_stem":
        message = f"{written} may be an index or a factor. Write * before a factor."
        return error(failure, "index", message, failure.replaced(f"*{details['digits']}"))
    run, digits = details["run"], details["digits"]
    message = f"{_COUNTING[details['style']]} {written} would be {run}{digits}"
    if details["reason"] == "shorthand" and run == "S":
        message = f"{written} is a number in SymPy, and may be a sine. Write {digits} or s{digits}."
        return error(failure, "index", message)
    if details["reason"] == "shorthand":
        message += ". Write the shorthand without brackets."
        return error(failure, "index", message, failure.replaced(f"{run}{digits}"))
    message += ", which is no name here. "
    if details["style"] == "(":
        return error(failure, "index", message + _PLAINLY)
    plain = f"{run}{int(digits) - 1}"
    message += f"If you mean {plain}, write it without brackets."
    return error(failure, "index", message, failure.replaced(plain))


def _no_number(failure: Failure) -> Repair:
    """Refuse q[i] and q[-1]."""
    start, end = failure.span
    if failure.source[end : end + 1] != "[" or _NUMBERED.match(failure.source, end):
        return None
    message = f"An index must be a positive whole number. {_PLAINLY}"
    return error(failure, "index", message, span=(start, end + 1))
