"""A sine of nothing: sin, sin(), sin * q1."""

from service.expressions.errors import ExpressionError, Span
from service.expressions.repairs.failure import Failure, Halt, halt, shown


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for the argument; offer sin(-q1) for sin -q1."""
    stopped = halt(failure)
    span = None if stopped is None else _function(stopped)
    if stopped is None or span is None:
        return None
    name = failure.source[span[0] : span[1]]
    return ExpressionError(
        "function_without_argument",
        f"The function {shown(name)} has nothing to work on; "
        "write its argument in brackets behind it.",
        span,
        _negative(failure, stopped),
    )


def _function(stopped: Halt) -> Span | None:
    if stopped.before == "FUNCTION":
        return stopped.span(1)
    empty = stopped.before == "LEFT" and stopped.terminal == "RIGHT" and stopped.index > 1
    if empty and stopped.tokens[stopped.index - 2][0] == "FUNCTION":
        return stopped.span(2)
    return None


def _negative(failure: Failure, stopped: Halt) -> str | None:
    tokens, at = stopped.tokens, stopped.index
    if stopped.terminal != "MINUS" or at + 1 >= len(tokens) or tokens[at + 1][0] != "NAME":
        return None
    start, end = tokens[at][2], tokens[at + 1][3]
    return failure.replaced(f"({failure.source[start:end]})", (tokens[at - 1][3], end))
