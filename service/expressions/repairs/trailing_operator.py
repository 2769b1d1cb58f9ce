"""A text that ends with an operator."""

from service.expressions.parsing.lexing.tokens import END
from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say

OPERATORS = frozenset({"PLUS", "MINUS", "STAR", "SLASH", "POWER", "ROOT"})


@for_causes("grammar")
def repair_trailing_operator(failure: Failure) -> Repair:
    """Suggest the text without the operator."""
    if failure.terminal() != END or failure.terminal(1) not in OPERATORS:
        return None
    start, end = span = failure.place(1)
    operator, before = failure.source[start:end], failure.source[:start].rstrip()
    message = say(
        "Something is missing after the {operator} at the end.", operator=quoted(operator)
    )
    return error(failure, "trailing_operator", message, before or None, span)
