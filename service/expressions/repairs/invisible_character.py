"""Invisible characters, which often come from pasting."""

import unicodedata

from service.expressions.characters.unicode import is_invisible
from service.expressions.repairs.failure import Failure, Repair, answers, error

# Pasted from a formula on a web page, this one is a product.
_INVISIBLE_TIMES = "\u2062"


@answers("invisible")
def repair(failure: Failure) -> Repair:
    """Name the character; offer the text without any, but not without an accent."""
    letter = failure.written
    name = unicodedata.name(letter, f"U+{ord(letter):04X}").lower()
    if letter == _INVISIBLE_TIMES:
        message = "There is an invisible product sign here, perhaps from pasting. Write * instead."
    elif unicodedata.category(letter) in {"Mn", "Me"} and not "\ufe00" <= letter <= "\ufe0f":
        message = f"There is a mark here that changes the letter before it ({name}). Delete it."
        return error(failure, "invisible_character", message)
    else:
        message = f"There is an invisible character here ({name}), perhaps from pasting. Delete it."
    product = failure.source.replace(_INVISIBLE_TIMES, "*")
    kept = (each for each in product if each in "\t\n\r" or not is_invisible(each))
    return error(failure, "invisible_character", message, "".join(kept))
