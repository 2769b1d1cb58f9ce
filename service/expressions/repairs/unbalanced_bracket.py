"""A bracket without its partner."""

from service.expressions.errors import ExpressionError, Span
from service.expressions.parsing.brackets import PARTNERS
from service.expressions.parsing.lexer import END, OPERAND_ENDS
from service.expressions.repairs.failure import (
    Failure,
    UnexpectedToken,
    position,
    quoted,
    unexpected_token,
)

_BEFORE_BRACKET = OPERAND_ENDS | {"LEFT"}


def repair(failure: Failure) -> ExpressionError | None:
    """Close the open brackets at the end of the text, or leave out the one that closes nothing."""
    if failure.cause == "unclosed":
        return _error(failure, failure.span, f"{failure.source}}}")
    unexpected = unexpected_token(failure)
    if unexpected is None or (unexpected.before and unexpected.before not in _BEFORE_BRACKET):
        return None
    opened = _opened(unexpected)
    if unexpected.terminal == "RIGHT" and not opened:
        return _error(failure, unexpected.span(), failure.replaced("", unexpected.span()))
    if unexpected.terminal == END and opened:
        closing = "".join(PARTNERS.get(failure.source[start], ")") for start, _ in opened[::-1])
        return _error(failure, opened[-1], f"{failure.source.rstrip()}{closing}")
    return None


def _opened(unexpected: UnexpectedToken) -> list[Span]:
    opened: list[Span] = []
    for token in unexpected.tokens[: unexpected.index]:
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
        f"The {quoted(bracket)} at {position(span)} has no {partner} bracket.",
        span,
        suggestion,
    )
