"""Data classes for new, recorded and listed attempts, and for filters of attempts.

This module loads no database driver.
"""

from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Final

MOST_ON_A_PAGE: Final = 100


def hint_points(price: float, max_points: float) -> float:
    """Return the points that hints cost, at most ``max_points``.

    ``price`` is the price of the hints as a fraction of ``max_points``.
    """
    return round(min(price, 1.0) * max_points, 6)


class GradesFormat(StrEnum):
    """The formats of exported attempts: all attempts, or a gradebook of those that count."""

    CSV = "csv"
    JSONL = "jsonl"
    CANVAS = "canvas"
    MOODLE = "moodle"

    @property
    def is_gradebook(self) -> bool:
        """True if the format is a gradebook, which has the points of one exercise only."""
        return self in (GradesFormat.CANVAS, GradesFormat.MOODLE)


@dataclass(frozen=True, slots=True)
class NewAttempt:
    """An attempt to be recorded; ``submission`` and ``report`` are JSON."""

    exercise: str
    learner: str
    # The attempt's number among the learner's counted attempts at the exercise; None if it does not
    # count.
    ordinal: int | None
    at: datetime
    is_late: bool
    worth: float
    submission: str
    answers_digest: str
    report: str
    version: str
    grader: str
    points: float
    max_points: float
    # The client that sent the attempt; idempotency keys are unique for each owner.
    owner: str
    idempotency_key: str | None
    request_digest: str
    # The number of an assignment of a course.
    assignment: int | None = field(default=None, kw_only=True)
    # The seed of a variant of the exercise.
    variant: str | None = field(default=None, kw_only=True)
    # The price of all hints that the learner has taken, as a share of the maximum points.
    hint_price: float = field(default=0.0, kw_only=True)


@dataclass(frozen=True, slots=True)
class RecordedAttempt(NewAttempt):
    """An attempt in the database."""

    number: int
    id: str

    @property
    def hint_points(self) -> float | None:
        """The points lost by hints taken before the attempt, or None."""
        return hint_points(self.hint_price, self.max_points) or None


@dataclass(frozen=True, slots=True)
class Standing:
    """A summary of a learner's attempts at an exercise, read just before a new attempt."""

    # The attempts that count towards the limit: those in the assignment or, without an assignment,
    # those outside of all assignments.
    counted: int
    # The attempt that was already recorded under the same idempotency key.
    earlier: RecordedAttempt | None
    # The highest ``ordinal`` of all attempts.
    last: int = 0
    # The price of all hints taken so far, as a share of the points.
    hint_price: float = 0.0


@dataclass(frozen=True, slots=True)
class AttemptFilter:
    """Conditions that select attempts; None means no condition."""

    # The id of an exercise, which selects all its variants, or the id of one variant.
    exercise: str | None = None
    learner: str | None = None
    # Inclusive; ``until`` is exclusive.
    since: datetime | None = None
    until: datetime | None = None
    counted: bool | None = None
    course: str | None = None
    # The id of an assignment of ``course``.
    assignment: str | None = None


@dataclass(frozen=True, slots=True)
class ListedAttempt:
    """An attempt without its answers and its report; ``awarded`` are points given by a tutor."""

    number: int
    id: str
    exercise: str
    learner: str
    ordinal: int | None
    at: datetime
    is_late: bool
    points: float
    max_points: float
    awarded: float | None
    version: str
    grader: str
    variant: str | None = None
    hint_price: float = 0.0

    @property
    def hint_points(self) -> float | None:
        """The points lost by hints taken before the attempt, or None."""
        return hint_points(self.hint_price, self.max_points) or None

    @property
    def earned(self) -> float:
        """The points that count: points given by a tutor, or else the points of the report."""
        return self.points if self.awarded is None else self.awarded
