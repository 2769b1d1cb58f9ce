"""Make a variant of an exercise. A short text, the seed, determines the variant."""

from collections import OrderedDict
from dataclasses import replace
from threading import Lock
from typing import Final

from pydantic import ValidationError

from service.catalogue import Exercise
from service.catalogue.robots.formulas import FieldError
from service.catalogue.varying.build import exercise_of_seed
from service.catalogue.varying.choices import is_seed
from service.catalogue.varying.vary import Vary
from service.translations import say

# A variant takes about 100 kB of memory.
MOST_BUILT: Final = 512


class NoVariantError(LookupError):
    """An exercise has no variant for this seed."""

    # Or no variants at all. The message is for people.


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
