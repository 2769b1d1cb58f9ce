"""The outline of an exercise on a server: the data needed to submit answers to it."""

from dataclasses import dataclass

from service.catalogue import Exercise, FeedbackLevel


@dataclass(frozen=True, slots=True)
class PartOutline:
    """A part of an exercise on a server."""

    id: str
    title: str
    points: float


@dataclass(frozen=True, slots=True)
class ExerciseOutline:
    """An exercise on a server. ``feedback`` is the highest level that the server gives."""

    id: str
    version: str
    title: str
    source: str
    feedback: FeedbackLevel
    parts: tuple[PartOutline, ...]


# An assigned exercise; this program can grade only an Exercise, not an ExerciseOutline.
SetExercise = Exercise | ExerciseOutline
