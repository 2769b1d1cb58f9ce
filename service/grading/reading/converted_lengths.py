"""Convert a length with a unit to a number: 135 mm is 0.135 in metres."""

import unicodedata
from decimal import Decimal
from typing import Final

from service.grading.reading.tables.words import METRES
from service.regex import regex

_LENGTH: Final = regex(
    r"(?P<sign>[-−–]?)\s{0,4}(?P<number>\d{1,12}(?:[.,]\d{1,12})?)\s{0,4}[(\[]?(?P<unit>[a-z]{1,12})"
    r"[)\]]?"
)
_SIUNITX: Final = regex(r"\\(?:SI|qty)\s{0,4}\{([^{}]{1,30})\}\s{0,4}\{([^{}]{1,30})\}")
# 1,350 mm is a metre and more, or a millimetre and more.
_THOUSANDS: Final = regex(r"[1-9]\d{0,2},\d{3}")


def converted(text: str, unit: str) -> str | None:
    """Return the number in ``unit`` for a length such as ``13.5 cm``; None for any other text."""
    plain = unicodedata.normalize("NFKC", _SIUNITX.sub(r"\1\2", text)).replace("\\", "")
    length = _LENGTH.fullmatch(plain.strip())
    if length is None or _THOUSANDS.fullmatch(length["number"]):
        return None
    if length["unit"] not in METRES or unit not in METRES:
        return None
    metres = Decimal(length["number"].replace(",", ".")) * Decimal(str(METRES[length["unit"]]))
    number = (metres / Decimal(str(METRES[unit]))).normalize()
    sign = "-" if length["sign"] and number else ""
    return f"{sign}{number:f}"
