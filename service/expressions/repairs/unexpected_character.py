"""A character that means nothing in a formula."""

from service.expressions.repairs.failure import Failure, Repair, error, quoted
from service.translations import say


def repair_unexpected_character(failure: Failure) -> Repair:
    """Name the character."""
    message = say(
        "The character {character} means nothing in a formula.", character=quoted(failure.written)
    )
    return error(failure, "unexpected_character", message)
