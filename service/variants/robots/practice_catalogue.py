"""A catalogue in which generated robots can be found by their ids."""

# They are not listed.

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Final

from service.catalogue import Exercise
from service.variants.robots.practice_id import PracticeId, practice_id
from service.variants.robots.robot_exercise import robot_exercise

# An exercise takes about 60 kB. A class at practice uses fewer robots at the same time.
MOST_ROBOTS: Final = 256


@lru_cache(maxsize=MOST_ROBOTS)
def _memoized(name: PracticeId) -> Exercise:
    return robot_exercise(name)


class CatalogueWithPractice(Mapping[str, Exercise]):
    """A catalogue of exercises, extended by all generated robots."""

    # They are made when they are asked for.

    def __init__(self, catalogue: Mapping[str, Exercise]) -> None:
        self._catalogue = catalogue

    def __getitem__(self, exercise_id: str) -> Exercise:
        name = practice_id(exercise_id)
        return self._catalogue[exercise_id] if name is None else _memoized(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._catalogue)

    def __len__(self) -> int:
        return len(self._catalogue)
