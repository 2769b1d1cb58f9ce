"""An exercise that is somewhere else: as much as one must know of it to hand answers in."""

from dataclasses import dataclass

from service.catalogue import Exercise, FeedbackLevel


@dataclass(frozen=True, slots=True)
class PartOutline:
    """A part of an exercise that is somewhere else."""

    id: str
    title: str
    points: float


@dataclass(frozen=True, slots=True)
class ExerciseOutline:
    """An exercise that is somewhere else. ``feedback`` is the most that its reports tell there."""

    id: str
    version: str
    title: str
    source: str
    feedback: FeedbackLevel
    parts: tuple[PartOutline, ...]


# An exercise that is set; only one that is here can be graded here.
SetExercise = Exercise | ExerciseOutline
