"""Find an exercise by its id, or suggest the nearest id."""

import difflib
from collections.abc import Iterable, Mapping
from typing import TypeVar, cast

from service.catalogue import Exercise
from service.translations import paragraph, say
from service.variants.variant import NoVariantError, variant_of

_T = TypeVar("_T")

# Longer names are cut: comparing takes more time, and nobody mistypes a name of this length.
_LONGEST = 64


class UnknownExerciseError(LookupError):
    """No exercise has this id; ``suggestion`` is the nearest known id, or None."""

    def __init__(self, exercise_id: str, known: tuple[str, ...], reason: str = "") -> None:
        self.known = known
        self.suggestion = None if reason else nearest(exercise_id, known)
        unknown: str = say("There is no exercise {exercise!r}.", exercise=exercise_id[:_LONGEST])
        if self.suggestion:
            meant = say("Did you mean {suggestion!r}?", suggestion=self.suggestion)
            unknown = paragraph(unknown, meant)
        super().__init__(reason or unknown)


def find_exercise(catalogue: Mapping[str, _T], exercise_id: str) -> _T:
    """Return the exercise, or the variant ``<exercise>~<seed>``, with this id.

    Raises UnknownExerciseError.
    """
    try:
        return catalogue[exercise_id]
    except KeyError:
        plain_id, tilde, seed = exercise_id.partition("~")
        exercise = catalogue.get(plain_id) if tilde else None
    if not isinstance(exercise, Exercise):
        raise UnknownExerciseError(plain_id, tuple(catalogue))
    try:
        return cast("_T", variant_of(exercise, seed))
    except NoVariantError as error:
        raise UnknownExerciseError(exercise_id, tuple(catalogue), error.args[0]) from error


def nearest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that was probably meant, or None."""
    matches = difflib.get_close_matches(name[:_LONGEST].lower(), list(known), n=1, cutoff=0.5)
    return matches[0] if matches else None
