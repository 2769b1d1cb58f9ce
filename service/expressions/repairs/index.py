"""Indices of programs that name no symbol: q[6] on six joints, or two styles in one text."""

from service.expressions.repairs.failure import Failure, Repair, answers, error, quoted

_COUNTING = {"[": "Python counts from 0, so", "(": "MATLAB counts from 1, so"}


@answers("index", "name")
def repair(failure: Failure) -> Repair:
    """Say how it was counted, and offer the plain name."""
    if failure.cause == "name":
        return _no_number(failure)
    details, written = failure.details, quoted(failure.written)
    if details["reason"] == "mixed":
        message = "Two ways to count joints are mixed here. Write q1 for joint 1."
        return error(failure, "mixed_index", message)
    if details["reason"] == "no_stem":
        message = f"{written} may be an index or a factor. Write * before a factor."
        return error(failure, "index", message, failure.replaced(f"*{details['digits']}"))
    run, digits = details["run"], details["digits"]
    message = f"{_COUNTING[details['style']]} {written} would be {run}{digits}"
    if details["reason"] == "shorthand":
        message += ". Write the shorthand without brackets."
        return error(failure, "index", message, failure.replaced(f"{run}{digits}"))
    message += ", which is no name here. Write q1 for joint 1."
    plain = failure.replaced(f"{run}{int(digits) - 1}") if details["style"] == "[" else None
    return error(failure, "index", message, plain)


def _no_number(failure: Failure) -> Repair:
    """Refuse q[i] and q[-1]."""
    start, end = failure.span
    if failure.source[end : end + 1] != "[":
        return None
    message = "An index in brackets is a number. Write q1 for joint 1."
    return error(failure, "index", message, span=(start, end + 1))
