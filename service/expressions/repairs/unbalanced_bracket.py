"""A bracket without its partner."""

from service.expressions.errors import Span
from service.expressions.parsing.lexing.brackets import PARTNERS
from service.expressions.parsing.lexing.tokens import END, OPERAND_ENDS
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say

_BEFORE_BRACKET = OPERAND_ENDS | {"LEFT"}


@for_causes("unclosed", "grammar")
def repair_unbalanced_bracket(failure: Failure) -> Repair:
    """Suggest closing all brackets at the end of the text, or removing a superfluous one."""
    if failure.cause == "unclosed":
        return _error(failure, failure.span, f"{failure.source}}}")
    if failure.terminal(1) and failure.terminal(1) not in _BEFORE_BRACKET:
        return None
    opened = _opened(failure)
    if failure.terminal() == "RIGHT" and not opened:
        return _error(failure, failure.span, failure.replaced(""))
    if failure.terminal() == END and opened:
        closing = "".join(PARTNERS.get(failure.source[start], ")") for start, _ in opened[::-1])
        return _error(failure, opened[-1], f"{failure.source.rstrip()}{closing}")
    return None


def _opened(failure: Failure) -> list[Span]:
    opened: list[Span] = []
    for terminal, _, start, end in failure.details["tokens"][: failure.details["index"]]:
        if terminal == "LEFT":
            opened.append((start, end))
        elif terminal == "RIGHT" and opened:
            opened.pop()
    return opened


def _error(failure: Failure, span: Span, suggestion: str) -> Repair:
    bracket = failure.source[slice(*span)]
    message = say(
        "The {bracket} at character {place} has no closing bracket.",
        bracket=quoted(bracket),
        place=span[0] + 1,
    )
    if bracket in {")", "]", "}"}:
        message = say(
            "The {bracket} at character {place} has no opening bracket.",
            bracket=quoted(bracket),
            place=span[0] + 1,
        )
    return error(failure, "unbalanced_bracket", message, suggestion, span)
