"""An attempt as it is written, found, listed and asked for; it loads no database driver."""

from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from typing import Final

MOST_ON_A_PAGE: Final = 100


class GradesFormat(StrEnum):
    """How attempts are exported: each of them, or the ones that count, for a gradebook."""

    CSV = "csv"
    JSONL = "jsonl"
    CANVAS = "canvas"
    MOODLE = "moodle"

    @property
    def is_gradebook(self) -> bool:
        """Whether it has one column, for one exercise."""
        return self in (GradesFormat.CANVAS, GradesFormat.MOODLE)


@dataclass(frozen=True, slots=True)
class NewAttempt:
    """An attempt as it is written; ``submission`` and ``report`` are JSON.

    ``ordinal`` is None for one that does not count. ``owner`` is who sent it, to whom alone the
    idempotency key belongs.
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


@dataclass(frozen=True, slots=True)
class RecordedAttempt(NewAttempt):
    """An attempt as it stands in the database."""

    number: int
    id: str


@dataclass(frozen=True, slots=True)
class Standing:
    """What is known before an attempt: the ``counted`` ones, or the one that this request made."""

    counted: int
    earlier: RecordedAttempt | None


@dataclass(frozen=True, slots=True)
class AttemptFilter:
    """Which attempts are read; None asks for nothing. ``since`` belongs to them, ``until`` not."""

    exercise: str | None = None
    learner: str | None = None
    since: datetime | None = None
    until: datetime | None = None
    counted: bool | None = None


@dataclass(frozen=True, slots=True)
class ListedAttempt:
    """An attempt without its answers and its report; ``awarded`` are the points of a tutor."""

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

    @property
    def earned(self) -> float:
        """The points that count: those of a tutor before those of the report."""
        return self.points if self.awarded is None else self.awarded
