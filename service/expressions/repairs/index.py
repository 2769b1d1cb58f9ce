"""Indices in brackets that do not name a symbol (q[6] with six joints), or in mixed styles."""

import re

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted

# A whole number in brackets; then the name before it is unknown, not the index.
_NUMBERED = re.compile(r"\[\s{0,8}\d+\s{0,8}\]")
_PLAINLY = "Write the index without brackets."
_COUNTING = {"[": "Python counts from 0, so", "(": "MATLAB counts from 1, so"}


@for_causes("index", "name")
def repair(failure: Failure) -> Repair:
    """Say how the index is counted, and suggest the name without brackets."""
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
    """Return the error for an index that is not a whole number: q[i], q[-1]."""
    start, end = failure.span
    if failure.source[end : end + 1] != "[" or _NUMBERED.match(failure.source, end):
        return None
    message = f"An index must be a positive whole number. {_PLAINLY}"
    return error(failure, "index", message, span=(start, end + 1))
