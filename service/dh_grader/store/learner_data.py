"""Database functions that read all records of one learner, and that delete old attempts."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    Table,
    and_,
    bindparam,
    delete,
    exists,
    func,
    insert,
    or_,
    select,
    update,
)
from sqlalchemy.exc import IntegrityError

from dh_grader.store import UnknownAttemptError, UnusablePointsError, shown_report, tables
from dh_grader.store.database import forget_scores, queue_scores
from dh_grader.store.tables import (
    assignments,
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
from dh_grader.translations import ENGLISH, say

# Changes by tutors: they override points, and delete the data of a learner.


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
        tables.learners,
        tables.handed_files,
    ):
        connection.execute(delete(table).where(table.c.learner == learner))
    return data


# Columns that are about the database and not about the learner, and columns of JSON. A learner does
# not see the seed of a variant.
_INNER: Final = {"number", "attempt", "assignment", "outcome", "digest", "variant"}
_JSON: Final = {"submission", "exercises", "content"}

# The learner's id at learning platforms, and the points that these got or wait for.
_AT_PLATFORMS: Final = (
    select(tables.registrations.c.name, tables.registrations.c.issuer)
    .add_columns(tables.learners.c.sub, tables.learners.c.launched_at)
    .join_from(tables.learners, tables.registrations)
    .where(tables.learners.c.learner == bindparam("learner"))
)
_SCORES: Final = (
    select(assignments.c.course, assignments.c.id.label("in_assignment"))
    .add_columns(
        *(
            tables.scores.c[name]
            for name in ("sub", "points", "max_points", "submitted_at", "state")
        ),
        *(tables.scores.c[name] for name in ("sent_at", "sent_points", "refusal")),
    )
    .join_from(tables.scores, tables.line_items)
    .join(assignments, assignments.c.number == tables.line_items.c.assignment)
    .where(tables.scores.c.learner == bindparam("learner"))
)


def everything_of(connection: Connection, learner: str) -> dict[str, Any]:
    """Return all records of a learner as values for JSON."""
    which = {"learner": learner}

    def rows(table: Table, condition: ColumnElement[bool]) -> list[dict[str, Any]]:
        found = connection.execute(select(table).where(condition)).all()
        return [_known(row) for row in found]

    def attempt(row: Row[Any]) -> dict[str, Any]:
        return _known(row) | {
            "overrides": rows(overrides, overrides.c.attempt == row.number),
            "earlier_reports": rows(earlier_reports, earlier_reports.c.attempt == row.number),
            "hints": rows(hints, hints.c.attempt == row.number),
        }

    mine = select(attempts, assignments.c.course, assignments.c.id.label("in_assignment"))
    recorded = connection.execute(
        mine.join_from(attempts, assignments, isouter=True)
        .where(attempts.c.learner == learner)
        .order_by(attempts.c.number)
    ).all()

    def assigned(table: Table) -> list[dict[str, Any]]:
        found = connection.execute(
            select(table, assignments.c.course, assignments.c.id.label("in_assignment"))
            .join_from(table, assignments)
            .where(table.c.learner == learner)
        )
        return [_known(row) for row in found]

    return {
        "learner": learner,
        "courses": rows(course_learners, course_learners.c.learner == learner),
        "extensions": assigned(extensions),
        "deals": assigned(deals),
        "links": rows(keys, keys.c.learner == learner),
        "attempts": [attempt(row) for row in recorded],
        "platforms": [_known(row) for row in connection.execute(_AT_PLATFORMS, which)],
        "scores": [_known(row) for row in connection.execute(_SCORES, which)],
        "handed_files": rows(tables.handed_files, tables.handed_files.c.learner == learner),
    }


def is_older(before: datetime) -> ColumnElement[bool]:
    """Return the SQL condition for attempts that are too old to be kept.

    Their retention time began before the moment ``before``.
    """
    # In an assignment, the time begins when the last learner can no longer hand in; without a due
    # date, it never begins.
    later = and_(
        extensions.c.assignment == assignments.c.number,
        func.coalesce(extensions.c.closes, extensions.c.due) >= before,
    )
    is_over = func.coalesce(assignments.c.closes, assignments.c.due) < before
    over = select(assignments.c.number).where(is_over, ~exists().where(later))
    of_none = attempts.c.assignment.is_(None)
    return and_(attempts.c.at < before, or_(of_none, attempts.c.assignment.in_(over)))


def delete_older(connection: Connection, before: datetime) -> int:
    """Delete the attempts that ``is_older`` selects; return the number of deleted attempts."""
    return delete_attempts(connection, is_older(before))


def delete_attempts(connection: Connection, chosen: ColumnElement[bool]) -> int:
    """Delete attempts with all records about them; return the number of attempts."""
    numbers = select(attempts.c.number).where(chosen)
    for table in (regrade_queue, earlier_reports, overrides, hints):
        connection.execute(delete(table).where(table.c.attempt.in_(numbers)))
    return connection.execute(delete(attempts).where(chosen)).rowcount


def months_before(now: datetime, months: int) -> datetime:
    """Return the time some months earlier; a day after the 28th becomes the 28th."""
    total = 12 * now.year + now.month - 1 - months
    return now.replace(year=total // 12, month=total % 12 + 1, day=min(now.day, 28))


def _known(row: Row[Any]) -> dict[str, Any]:
    return {name: _plain(name, value) for name, value in _named(row).items() if value is not None}


def _named(row: Row[Any]) -> Mapping[str, Any]:
    return {name: value for name, value in row._mapping.items() if name not in _INNER}


def _plain(name: str, value: Any) -> Any:
    if isinstance(value, datetime):
        return value.isoformat()
    if name == "report":
        return json.loads(shown_report(value, ENGLISH))
    return json.loads(value) if name in _JSON else value
