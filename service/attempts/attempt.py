"""Data classes for new, recorded and listed attempts, and for filters of attempts.

This module loads no database driver.
"""

from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Final

MOST_ON_A_PAGE: Final = 100


def hint_points(price: float, max_points: float) -> float:
    """Return the cost of hints: ``price`` times ``max_points``, but at most ``max_points``."""
    return round(min(price, 1.0) * max_points, 6)


class GradesFormat(StrEnum):
    """The formats of exported attempts: all attempts, or a gradebook of those that count."""

    CSV = "csv"
    JSONL = "jsonl"
    CANVAS = "canvas"
    MOODLE = "moodle"

    @property
    def is_gradebook(self) -> bool:
        """True if the format is a gradebook; a gradebook has the points of one exercise only."""
        return self in (GradesFormat.CANVAS, GradesFormat.MOODLE)


@dataclass(frozen=True, slots=True)
class NewAttempt:
    """An attempt to be recorded; ``submission`` and ``report`` are JSON.

    ``ordinal`` is the attempt's number among the learner's counted attempts at the exercise; None
    if the attempt does not count. ``owner`` is the client that sent the attempt; idempotency keys
    are unique for each owner. ``assignment`` is the number of an assignment of a course, or None.
    ``variant`` is the seed of a variant of the exercise, or None. ``hint_price`` is the price of
    all hints that the learner has taken, as a share of the attempt's maximum points.
    """

    exercise: str
    learner: str
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
    owner: str
    idempotency_key: str | None
    request_digest: str
    assignment: int | None = field(default=None, kw_only=True)
    variant: str | None = field(default=None, kw_only=True)
    hint_price: float = field(default=0.0, kw_only=True)


@dataclass(frozen=True, slots=True)
class RecordedAttempt(NewAttempt):
    """An attempt in the database."""

    number: int
    id: str

    @property
    def hint_points(self) -> float | None:
        """The points that the hints before the attempt cost; None if they cost nothing."""
        return hint_points(self.hint_price, self.max_points) or None


@dataclass(frozen=True, slots=True)
class Standing:
    """The attempts of a learner at an exercise, just before a new attempt.

    ``counted`` is the number of attempts that count towards the limit: those in the assignment or,
    without an assignment, those outside of all assignments. ``earlier`` is the attempt that was
    already recorded under the same idempotency key, if any. ``last`` is the highest number
    (``ordinal``) of all attempts. ``hint_price`` is the price of all hints taken so far, as a share
    of the points.
    """

    counted: int
    earlier: RecordedAttempt | None
    last: int = 0
    hint_price: float = 0.0


@dataclass(frozen=True, slots=True)
class AttemptFilter:
    """A filter on attempts; None means no condition. ``since`` is inclusive, ``until`` is not.

    ``assignment`` is the id of an assignment of ``course``. ``exercise`` is the id of an exercise,
    which selects all its variants, or the id of one variant.
    """

    exercise: str | None = None
    learner: str | None = None
    since: datetime | None = None
    until: datetime | None = None
    counted: bool | None = None
    course: str | None = None
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
        """The points that the hints before the attempt cost; None if they cost nothing."""
        return hint_points(self.hint_price, self.max_points) or None

    @property
    def earned(self) -> float:
        """The points that count: points awarded by a tutor, or else the points of the report."""
        return self.points if self.awarded is None else self.awarded
