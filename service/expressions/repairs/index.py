"""Indices of programs that name no symbol: q[6] on six joints, or two styles in one text."""

from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure, quoted

_COUNTING = {"[": "Python counts from 0, so", "(": "MATLAB counts from 1, so"}


def repair(failure: Failure) -> ExpressionError | None:
    """Say how it was counted, and offer the plain name."""
    if failure.cause == "name":
        return _no_number(failure)
    if failure.cause != "index":
        return None
    details, written = failure.details, quoted(failure.written)
    if details["reason"] == "mixed":
        return ExpressionError(
            "mixed_index",
            "Two ways to count joints are mixed here. Write plain names: q1 for joint 1.",
            failure.span,
        )
    if details["reason"] == "no_stem":
        return ExpressionError(
            "index",
            f"{written} may be an index or a factor; write * before a factor.",
            failure.span,
            failure.replaced(f"*{details['digits']}"),
        )
    run, digits = details["run"], details["digits"]
    if details["reason"] == "shorthand":
        return ExpressionError(
            "index",
            f"{_COUNTING[details['style']]} {written} would be {run}{digits}; write the shorthand "
            "without brackets.",
            failure.span,
            failure.replaced(f"{run}{digits}"),
        )
    name = f"{run}{digits}"
    return ExpressionError(
        "index",
        f"{_COUNTING[details['style']]} {written} would be {name}, and there is no such symbol "
        "here. Write plain names: q1 for joint 1.",
        failure.span,
        failure.replaced(f"{run}{int(digits) - 1}") if details["style"] == "[" else None,
    )


def _no_number(failure: Failure) -> ExpressionError | None:
    """Refuse q[i] and q[-1]."""
    end = failure.span[1]
    if failure.source[end : end + 1] != "[":
        return None
    message = "An index in brackets is a number, for example q[0]; or write plain names, as q1."
    return ExpressionError("index", message, (failure.span[0], end + 1))
