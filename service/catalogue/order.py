"""The order of the exercises in the catalogue."""

from collections.abc import Iterable
from itertools import groupby
from typing import Final

from service.catalogue.exercise import Exercise
from service.catalogue.level import ExerciseLevel
from service.translations import say

_LEVELS: Final = tuple(ExerciseLevel)
_HEADINGS: Final = {
    ExerciseLevel.START: say("Start here"),
    ExerciseLevel.BASICS: say("Basics"),
    ExerciseLevel.ARMS: say("Arms"),
    ExerciseLevel.INDUSTRIAL: say("Industrial robots"),
    None: say("More exercises"),
}


def in_order(exercises: Iterable[Exercise]) -> dict[str, Exercise]:
    """Sort exercises by level, then by ``order``; exercises without these fields come last."""
    return {exercise.id: exercise for exercise in sorted(exercises, key=_place)}


def by_level(exercises: Iterable[Exercise]) -> list[tuple[str, list[Exercise]]]:
    """Return each level's heading with its exercises, in the order of the catalogue."""
    groups = groupby(in_order(exercises).values(), key=lambda exercise: exercise.level)
    return [(_HEADINGS[level], list(group)) for level, group in groups]


def exercise_after(exercise_id: str, exercises: Iterable[Exercise]) -> Exercise | None:
    """Return the exercise after ``exercise_id`` in the catalogue, or None for the last."""
    following = iter(in_order(exercises).values())
    found = any(exercise.id == exercise_id for exercise in following)
    return next(following, None) if found else None


def _place(exercise: Exercise) -> tuple[int, bool, int]:
    level = len(_LEVELS) if exercise.level is None else _LEVELS.index(exercise.level)
    return level, exercise.order is None, exercise.order or 0
