"""A character that means nothing here."""

from service.expressions.repairs.failure import Failure, Repair, error, quoted


def repair(failure: Failure) -> Repair:
    """Name it."""
    message = f"The character {quoted(failure.written)} means nothing in a formula."
    return error(failure, "unexpected_character", message)
