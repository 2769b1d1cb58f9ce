"""The seed of a learner, a short text that determines the learner's variant.

The seed is derived from a secret, so that learners can neither compute nor choose it.
"""

# If the exercise file lists seeds that a tutor has checked (deployed seeds), the learner gets the
# one with the largest keyed hash. So one more seed in the list changes the variants of only a few
# learners.

import hashlib
import hmac
from collections.abc import Sequence
from typing import Final

# The letters of a free seed: 36^16 seeds cannot be tried.
_DIGITS: Final = "0123456789abcdefghijklmnopqrstuvwxyz"
_LENGTH: Final = 16


def seed_of(
    secret: str, learner: str, exercise: str, number: int, deployed: Sequence[str] = ()
) -> str:
    """Return the seed of a learner's variant."""
    # ``number`` says how many times the learner got another variant.
    if deployed:
        return max(deployed, key=lambda seed: _keyed(secret, learner, exercise, number, seed))
    whole = int.from_bytes(_keyed(secret, learner, exercise, number, ""), "big")
    digits = []
    for _ in range(_LENGTH):
        whole, digit = divmod(whole, len(_DIGITS))
        digits.append(_DIGITS[digit])
    return "".join(digits)


def _keyed(secret: str, learner: str, exercise: str, number: int, seed: str) -> bytes:
    # The lengths keep the parts apart, whatever they contain.
    parts = (exercise, learner, str(number), seed)
    message = "".join(f"{len(part)}:{part}" for part in parts).encode("utf-8", "surrogatepass")
    return hmac.new(secret.encode(), message, hashlib.sha256).digest()
