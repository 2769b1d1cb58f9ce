"""The text of an API key: a prefix, random characters, and a checksum."""

# The prefix lets scanners find keys that were published by mistake. The checksum lets the service
# refuse a misspelt key without asking the database.

import secrets
import string
from typing import Final
from zlib import crc32

PREFIX: Final = "dhg_"
_ALPHABET: Final = string.digits + string.ascii_letters
# 190 random bits.
_RANDOM: Final = 32
_CHECKSUM: Final = 6


def new_key_text() -> str:
    """Return the text of a new random key."""
    drawn = "".join(secrets.choice(_ALPHABET) for _ in range(_RANDOM))
    return f"{PREFIX}{drawn}{_checksum(drawn)}"


def key_text_of(seed: bytes) -> str:
    """Return the text of a key made of 64 bytes; equal bytes give equal texts."""
    rest = int.from_bytes(seed)
    digits = []
    for _ in range(_RANDOM):
        rest, digit = divmod(rest, len(_ALPHABET))
        digits.append(_ALPHABET[digit])
    drawn = "".join(digits)
    return f"{PREFIX}{drawn}{_checksum(drawn)}"


def is_spelt_right(text: str) -> bool:
    """True if a text has the form of a key and a correct checksum."""
    drawn, checksum = text[len(PREFIX) : -_CHECKSUM], text[-_CHECKSUM:]
    return (
        text.startswith(PREFIX)
        and len(drawn) == _RANDOM
        and set(text[len(PREFIX) :]) <= set(_ALPHABET)
        and checksum == _checksum(drawn)
    )


def _checksum(drawn: str) -> str:
    rest = crc32(drawn.encode())
    digits = []
    for _ in range(_CHECKSUM):
        rest, digit = divmod(rest, len(_ALPHABET))
        digits.append(_ALPHABET[digit])
    return "".join(digits)
