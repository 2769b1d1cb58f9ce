"""Letters of another alphabet that look like those of a formula."""

import unicodedata

from service.expressions.characters.unicode import LOOK_ALIKES
from service.expressions.errors import ExpressionError
from service.expressions.repairs.failure import Failure


def repair(failure: Failure) -> ExpressionError | None:
    """Name the letter, and offer the text with all such letters replaced."""
    if failure.cause != "look_alike":
        return None
    letter = failure.written
    plain = LOOK_ALIKES[letter]
    return ExpressionError(
        "look_alike_character",
        f"This only looks like the letter {plain}: it is the {unicodedata.name(letter).lower()}. "
        f"Type {plain} instead.",
        failure.span,
        "".join(LOOK_ALIKES.get(letter, letter) for letter in failure.source),
    )
