"""An exercise and a seed -> a variant; which variant a learner gets."""

import hashlib
import hmac
import json
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from threading import Lock
from typing import Any, Final

from pydantic import ValidationError

from dh_grader.catalogue import Exercise
from dh_grader.catalogue.load import exercise_of_seed
from dh_grader.catalogue.robot import FieldError
from dh_grader.catalogue.varying import Vary, is_seed
from dh_grader.translations import say

# --- The seed of a learner's variant
#
# If the exercise file lists seeds that a tutor has checked (deployed seeds), the learner gets the
# one with the largest keyed hash. So one more seed in the list changes the variants of only a few
# learners.


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


# --- Keep the variants of an assignment when an exercise file is corrected
#
# The table ``[vary]`` of a file says which numbers its variants may have. An assignment stores a
# copy of this table and uses it instead of the file's table.


# As many exercises in assignments are used at the same time.
_MOST: Final = 256


def choices_of(exercises: Mapping[str, Exercise]) -> Mapping[str, Any]:
    """Return the table ``[vary]`` of each exercise that has this table."""
    return {name: each.vary.table for name, each in exercises.items() if each.vary is not None}


def pinned(exercise: Exercise, choices: str | None) -> Exercise:
    """Return the exercise with the table ``[vary]`` that an assignment has stored.

    ``choices`` is a JSON object with the stored table of each exercise.
    """
    # The table of the file stays if none is stored, or if the stored table no longer fits the texts
    # of the file.
    if exercise.vary is None or choices is None:
        return exercise
    vary = _pinned(exercise.vary, exercise.plain_id, choices)
    return exercise if vary is exercise.vary else replace(exercise, vary=vary)


@lru_cache(maxsize=_MOST)
def _pinned(vary: Vary, exercise: str, choices: str) -> Vary:
    table = json.loads(choices).get(exercise)
    if table is None or table == vary.table:
        return vary
    try:
        return vary.with_choices(table)
    except FieldError:
        return vary


# --- Make a variant of an exercise. A short text, the seed, determines the variant


# A variant takes about 100 kB of memory.
MOST_BUILT: Final = 512


class NoVariantError(LookupError):
    """An exercise has no variant for this seed, or none at all. The message is for people."""


def built(exercise: Exercise, seed: str) -> Exercise:
    """Return a newly built variant, with the id ``<exercise>~<seed>``. Raises NoVariantError."""
    # See ``variant_of``.
    if exercise.vary is None:
        raise NoVariantError(
            say("The exercise {exercise} has no variants.", exercise=exercise.plain_id)
        )
    if not is_seed(seed):
        raise NoVariantError(say("The seed of a variant has 1 to 20 small letters and digits."))
    try:
        return exercise_of_seed(exercise, seed)
    except (ValidationError, FieldError, ExceptionGroup) as error:
        message = say(
            "The variant {variant} cannot be made: its file has a fault.",
            variant=f"{exercise.plain_id}~{seed}",
        )
        raise NoVariantError(message) from error


class BuiltVariants:
    """A cache of the variants that were used last; ``most`` is its size."""

    def __init__(self, most: int = MOST_BUILT) -> None:
        self._most = most
        self._built: OrderedDict[tuple[Vary, str], Exercise] = OrderedDict()
        self._lock = Lock()

    def __len__(self) -> int:
        return len(self._built)

    def get(self, exercise: Exercise, seed: str) -> Exercise:
        """Return a variant from the cache, or build it. Raises NoVariantError."""
        if exercise.vary is None:
            return built(exercise, seed)
        # A changed file has another ``Vary``, so that its variants are built again.
        key = (exercise.vary, seed)
        with self._lock:
            if key in self._built:
                self._built.move_to_end(key)
                return self._built[key]
        variant = built(exercise, seed)
        with self._lock:
            self._built[key] = variant
            while len(self._built) > self._most:
                self._built.popitem(last=False)
        return variant


_variants: Final = BuiltVariants()


def variant_of(exercise: Exercise, seed: str) -> Exercise:
    """Return the variant of a seed, if possible from a cache. Raises NoVariantError."""
    return _variants.get(exercise, seed)


def values_of(version: str) -> str:
    """Return the part of a variant's version that depends only on the variant's values."""
    return version.partition("-")[2]


def hidden_variant(exercise: Exercise, seed: str) -> Exercise:
    """Return the variant of a seed, with an id that hides the seed. Raises NoVariantError."""
    # The id is that of the plain exercise.
    return replace(variant_of(exercise, seed), id=exercise.plain_id)
