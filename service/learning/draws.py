"""Pseudo-random numbers that are the same on every computer: integers from SHA-256 of a text."""

from collections.abc import Sequence
from hashlib import sha256
from itertools import count
from typing import Final, TypeVar

T = TypeVar("T")

_BYTES: Final = 8


class SlipDraws:
    """A sequence of pseudo-random numbers. Equal texts give equal sequences."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._blocks = count()

    def below(self, limit: int) -> int:
        """Return a pseudo-random integer from 0 to ``limit - 1``."""
        digest = sha256(f"{self._text}\n{next(self._blocks)}".encode()).digest()
        return int.from_bytes(digest[:_BYTES], "big") * limit >> 8 * _BYTES

    def shuffled(self, values: Sequence[T]) -> list[T]:
        """Return the values in a random order."""
        left = list(values)
        return [left.pop(self.below(len(left))) for _ in values]
