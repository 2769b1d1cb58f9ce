"""A character that means nothing in a formula."""

from service.expressions.repairs.failure import Failure, Repair, error, quoted


def repair(failure: Failure) -> Repair:
    """Name the character."""
    message = f"The character {quoted(failure.written)} means nothing in a formula."
    return error(failure, "unexpected_character", message)
