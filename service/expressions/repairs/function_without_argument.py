"""A function without its argument: sin, sin(), sin * q1."""

from service.expressions.errors import ExpressionError, Span
from service.expressions.repairs.failure import Failure, UnexpectedToken, quoted, unexpected_token


def repair(failure: Failure) -> ExpressionError | None:
    """Ask for the argument; offer sin(-q1) for sin -q1."""
    unexpected = unexpected_token(failure)
    span = None if unexpected is None else _function(unexpected)
    if unexpected is None or span is None:
        return None
    name = failure.source[span[0] : span[1]]
    return ExpressionError(
        "function_without_argument",
        f"The function {quoted(name)} has nothing to work on; "
        "write its argument in brackets behind it.",
        span,
        _negative(failure, unexpected),
    )


def _function(unexpected: UnexpectedToken) -> Span | None:
    if unexpected.before == "FUNCTION":
        return unexpected.span(1)
    empty = unexpected.before == "LEFT" and unexpected.terminal == "RIGHT" and unexpected.index > 1
    if empty and unexpected.tokens[unexpected.index - 2][0] == "FUNCTION":
        return unexpected.span(2)
    return None


def _negative(failure: Failure, unexpected: UnexpectedToken) -> str | None:
    tokens, at = unexpected.tokens, unexpected.index
    if unexpected.terminal != "MINUS" or at + 1 >= len(tokens) or tokens[at + 1][0] != "NAME":
        return None
    start, end = tokens[at][2], tokens[at + 1][3]
    return failure.replaced(f"({failure.source[start:end]})", (tokens[at - 1][3], end))
