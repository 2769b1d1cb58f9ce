"""Changes by tutors: they override points, and delete the data of a learner."""

from dataclasses import dataclass
from datetime import datetime
from typing import Final

from sqlalchemy import Connection, delete, func, insert, select, update
from sqlalchemy.exc import IntegrityError

from service.attempts.errors import UnknownAttemptError, UnusablePointsError
from service.attempts.storage import lti_tables
from service.attempts.storage.score_queue import forget_scores, queue_scores
from service.attempts.storage.tables import (
    attempts,
    course_learners,
    deals,
    earlier_reports,
    extensions,
    hints,
    keys,
    overrides,
    regrade_queue,
)
from service.translations import say

# How often PostgreSQL may report a concurrent write while a learner is being deleted.
_TRIES: Final = 4


def override(
    connection: Connection,
    attempt_id: str,
    points: float | None,
    reason: str,
    author: str,
    at: datetime,
) -> None:
    """Override the points of an attempt's report; ``points=None`` withdraws the override.

    Raises UnknownAttemptError, UnusablePointsError.
    """
    found = connection.execute(
        select(attempts.c.number, attempts.c.max_points).where(attempts.c.id == attempt_id)
    ).one_or_none()
    if found is None:
        raise UnknownAttemptError(attempt_id)
    if points is not None and not 0 <= points <= found.max_points:
        most = f"{found.max_points:g}"
        raise UnusablePointsError(say("The attempt may have 0 to {most} points.", most=most))
    connection.execute(
        insert(overrides).values(
            attempt=found.number, points=points, reason=reason, author=author, at=at
        )
    )
    connection.execute(
        update(attempts).where(attempts.c.number == found.number).values(awarded=points)
    )
    queue_scores(connection, attempts.c.number == found.number)


@dataclass(frozen=True, slots=True)
class LearnerData:
    """Counts of a learner's attempts, earlier reports, overrides and courses."""

    attempts: int
    earlier_reports: int
    overrides: int
    courses: int


def data_of(connection: Connection, learner: str) -> LearnerData:
    """Count the records of a learner."""
    mine = select(attempts.c.number).where(attempts.c.learner == learner)
    columns = (attempts.c.number, earlier_reports.c.attempt, overrides.c.attempt)
    counts = [select(func.count(column)).where(column.in_(mine)) for column in columns]
    enrolled = course_learners.c.learner
    counts.append(select(func.count(enrolled)).where(enrolled == learner))
    return LearnerData(*(connection.scalar(count) or 0 for count in counts))


def forget(connection: Connection, learner: str) -> LearnerData:
    """Delete all records of a learner, also in courses; return their counts."""
    for _ in range(_TRIES):
        try:
            with connection.begin_nested():
                return _forget(connection, learner)
        except IntegrityError:
            # After the rows were deleted, another process has given points or begun a regrade.
            continue
    return _forget(connection, learner)


def _forget(connection: Connection, learner: str) -> LearnerData:
    data = data_of(connection, learner)
    mine = select(attempts.c.number).where(attempts.c.learner == learner)
    for table in (regrade_queue, earlier_reports, overrides, hints):
        connection.execute(delete(table).where(table.c.attempt.in_(mine)))
    forget_scores(connection, learner)
    for table in (
        attempts,
        extensions,
        deals,
        course_learners,
        keys,
        lti_tables.learners,
        lti_tables.handed_files,
    ):
        connection.execute(delete(table).where(table.c.learner == learner))
    return data
