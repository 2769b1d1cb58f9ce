"""Letters of another alphabet that look like Latin or Greek letters."""

import unicodedata

from service.expressions.characters.unicode import LOOK_ALIKES
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("look_alike")
def repair_look_alike_character(failure: Failure) -> Repair:
    """Name the letter, and suggest the text with all look-alike letters replaced."""
    letter = failure.written
    plain = LOOK_ALIKES[letter]
    message = say(
        "This looks like the letter {letter}, but is the {name}. Type {letter}.",
        letter=plain,
        name=unicodedata.name(letter).lower(),
    )
    repaired = "".join(LOOK_ALIKES.get(letter, letter) for letter in failure.source)
    return error(failure, "look_alike_character", message, repaired)
