"""What tutors change: points in place of a report's, and the data of a learner deleted."""

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import Connection, Engine, delete, func, insert, select, text, update

from service.attempts.errors import UnknownAttemptError, UnusablePointsError
from service.attempts.tables import attempts, earlier_reports, overrides, regrade_queue


def override(
    connection: Connection,
    attempt_id: str,
    points: float | None,
    reason: str,
    author: str,
    at: datetime,
) -> None:
    """Give an attempt these points in place of its report's; None withdraws what was given.

    Raises UnknownAttemptError, UnusablePointsError.
    """
    found = connection.execute(
        select(attempts.c.number, attempts.c.max_points).where(attempts.c.id == attempt_id)
    ).one_or_none()
    if found is None:
        raise UnknownAttemptError(attempt_id)
    if points is not None and not 0 <= points <= found.max_points:
        raise UnusablePointsError(f"The attempt may have 0 to {found.max_points:g} points.")
    connection.execute(
        insert(overrides).values(
            attempt=found.number, points=points, reason=reason, author=author, at=at
        )
    )
    connection.execute(
        update(attempts).where(attempts.c.number == found.number).values(awarded=points)
    )


@dataclass(frozen=True, slots=True)
class LearnerData:
    """How many rows of each kind belong to a learner."""

    attempts: int
    earlier_reports: int
    overrides: int


def data_of(connection: Connection, learner: str) -> LearnerData:
    """What is recorded of a learner."""
    mine = select(attempts.c.number).where(attempts.c.learner == learner)
    columns = (attempts.c.number, earlier_reports.c.attempt, overrides.c.attempt)
    counts = (select(func.count(column)).where(column.in_(mine)) for column in columns)
    return LearnerData(*(connection.scalar(count) or 0 for count in counts))


def forget(connection: Connection, learner: str) -> LearnerData:
    """Delete all that is recorded of a learner, and tell how much it was.

    Outcomes stay: they hold verdicts and codes, and neither learners nor answers.
    """
    if connection.dialect.name == "sqlite":
        connection.execute(text("PRAGMA secure_delete = ON"))
    data = data_of(connection, learner)
    mine = select(attempts.c.number).where(attempts.c.learner == learner)
    for table in (regrade_queue, earlier_reports, overrides):
        connection.execute(delete(table).where(table.c.attempt.in_(mine)))
    connection.execute(delete(attempts).where(attempts.c.learner == learner))
    return data


def overwrite_deleted(engine: Engine) -> None:
    """Overwrite what was deleted where it still stands: in SQLite, in the file of late changes."""
    if engine.dialect.name == "sqlite":
        with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text("PRAGMA wal_checkpoint(TRUNCATE)"))
