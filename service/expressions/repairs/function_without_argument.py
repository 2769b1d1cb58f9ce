"""A function without its argument: sin, sin(), sin * q1."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


@for_causes("grammar")
def repair_function_without_argument(failure: Failure) -> Repair:
    """Ask for the argument; suggest sin(-q1) for sin -q1."""
    if failure.terminal(1) == "FUNCTION":
        span = failure.place(1)
    elif [failure.terminal(back) for back in (2, 1, 0)] == ["FUNCTION", "LEFT", "RIGHT"]:
        span = failure.place(2)
    else:
        return None
    suggestion = None
    if failure.terminal() == "MINUS" and failure.terminal(-1) == "NAME":
        start, end = failure.span[0], failure.place(-1)[1]
        suggestion = failure.replaced(f"({failure.source[start:end]})", (span[1], end))
    message = say(
        "{function} has no argument. Write it in brackets, as in sin(x).",
        function=quoted(failure.source[slice(*span)]),
    )
    return error(failure, "function_without_argument", message, suggestion, span)
