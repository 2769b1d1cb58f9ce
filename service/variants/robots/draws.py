"""Pseudo-random numbers that are the same on every computer: integers from SHA-256 of a text."""

from collections.abc import Iterator, Sequence
from hashlib import sha256
from itertools import count
from typing import Final, TypeVar

T = TypeVar("T")

_BITS: Final = 32


class Draws:
    """A sequence of pseudo-random numbers. Equal texts give equal sequences."""

    def __init__(self, text: str) -> None:
        self._words = _words(text)

    def below(self, limit: int) -> int:
        """Return a pseudo-random integer from 0 to ``limit - 1``."""
        # All have nearly the same probability.
        return next(self._words) * limit >> _BITS

    def chance(self, percent: int) -> bool:
        """True with a probability of ``percent`` %."""
        return self.below(100) < percent

    def one_of(self, choices: Sequence[T]) -> T:
        """Return one of the choices; all are equally likely."""
        return choices[self.below(len(choices))]

    def weighted(self, choices: Sequence[tuple[T, int]]) -> T:
        """Return one of the choices, each with a weight; a greater weight is more probable."""
        # At least one weight must be positive.
        left = self.below(sum(weight for _, weight in choices))
        for choice, weight in choices:
            left -= weight
            if left < 0:
                return choice
        raise AssertionError("the weights add up to more than their sum")


def _words(text: str) -> Iterator[int]:
    for block in count():
        digest = sha256(f"{text}\n{block}".encode()).digest()
        for i in range(0, len(digest), _BITS // 8):
            yield int.from_bytes(digest[i : i + _BITS // 8], "big")
