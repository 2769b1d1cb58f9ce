"""A star after a joint variable that may mark the variable or be a product: k*q1*+s1."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes, quoted
from service.translations import say


@for_causes("ambiguous_star")
def repair_ambiguous_star(failure: Failure) -> Repair:
    """Explain that the star is ambiguous, and suggest the text without the star."""
    (start, end) = failure.details["star"]
    variable = failure.source[failure.span[0] : start].strip()
    message = say(
        "The * after {written} may mark the joint variable. Delete it, or write the product as "
        "{variable}*(…).",
        written=quoted(variable),
        variable=variable,
    )
    return error(failure, "ambiguous_star", message, failure.replaced("", (start, end)))
