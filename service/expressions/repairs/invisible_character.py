"""Invisible characters, which often come from pasting."""

import unicodedata

from service.expressions.characters.unicode import is_invisible
from service.expressions.repairs.failure import Failure, Repair, error, for_causes
from service.translations import say


@for_causes("invisible")
def repair_invisible_character(failure: Failure) -> Repair:
    """Name the character, and suggest the text without invisible characters."""
    letter = failure.written
    name = unicodedata.name(letter, f"U+{ord(letter):04X}").lower()
    if unicodedata.category(letter) in {"Mn", "Me"} and not "\ufe00" <= letter <= "\ufe0f":
        message = say(
            "There is a mark here that changes the letter before it ({name}). Delete it.",
            name=name,
        )
        return error(failure, "invisible_character", message)
    message = say(
        "There is an invisible character here ({name}), perhaps from pasting. Delete it.",
        name=name,
    )
    kept = (each for each in failure.source if each in "\t\n\r" or not is_invisible(each))
    return error(failure, "invisible_character", message, "".join(kept))
