"""Two values instead of one: ``2 3``, ``q1, q2``, ``90° (π/2)``, or a second line."""

from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("values", "grammar")
def repair_two_values(failure: Failure) -> Repair:
    """Ask the student for one value, or for an operator between the two values."""
    start, end = failure.span
    if failure.terminal(1) and failure.terminal() != "COMMA":
        start = failure.place(1)[0]
    message = say("Two values stand side by side. Write one value, or an operator between them.")
    return error(failure, "two_values", message, failure.details.get("instead"), (start, end))
