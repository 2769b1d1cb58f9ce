"""The levels of the catalogue."""

from enum import StrEnum


class ExerciseLevel(StrEnum):
    """The level of an exercise, from the first to the hardest."""

    START = "start"
    BASICS = "basics"
    ARMS = "arms"
    INDUSTRIAL = "industrial"
