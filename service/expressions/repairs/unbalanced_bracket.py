"""A bracket without its partner."""

from service.expressions.errors import ExpressionError, Span
from service.expressions.parsing.brackets import PARTNERS
from service.expressions.parsing.lexer import END
from service.expressions.repairs.failure import Failure, Halt, halt, place, shown

_VALUES = frozenset({"NUMBER", "NAME", "RIGHT", "CLOSE", "UNIT", "LEFT"})


def repair(failure: Failure) -> ExpressionError | None:
    """Close what is open at the end of the text, or leave out what closes nothing."""
    if failure.stop.cause == "unclosed":
        return _error(failure, failure.span, f"{failure.source}}}")
    stopped = halt(failure)
    if stopped is None or (stopped.before and stopped.before not in _VALUES):
        return None
    opened = _opened(stopped)
    if stopped.terminal == "RIGHT" and not opened:
        return _error(failure, stopped.span(), failure.replaced("", stopped.span()))
    if stopped.terminal == END and opened:
        closing = "".join(PARTNERS.get(failure.source[start], ")") for start, _ in opened[::-1])
        return _error(failure, opened[-1], f"{failure.source.rstrip()}{closing}")
    return None


def _opened(stopped: Halt) -> list[Span]:
    opened: list[Span] = []
    for token in stopped.tokens[: stopped.index]:
        if token[0] == "LEFT":
            opened.append(token[2:])
        elif token[0] == "RIGHT" and opened:
            opened.pop()
    return opened


def _error(failure: Failure, span: Span, suggestion: str) -> ExpressionError:
    bracket = failure.source[span[0] : span[1]]
    partner = "opening" if bracket in {")", "]", "}"} else "closing"
    return ExpressionError(
        "unbalanced_bracket",
        f"The {shown(bracket)} at {place(span)} has no {partner} bracket.",
        span,
        suggestion,
    )
