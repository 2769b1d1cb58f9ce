"""Read recorded attempts: lists page by page, or one attempt with its history."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any, Final

from sqlalchemy import ColumnElement, Connection, Row, Tuple, and_, literal, select, tuple_

from service.attempts.attempt import AttemptFilter, ListedAttempt
from service.attempts.errors import BadCursorError
from service.attempts.hints import hints_before
from service.attempts.storage.tables import (
    UtcTime,
    assignments,
    attempts,
    earlier_reports,
    overrides,
)
from service.contract.attempts import TakenHint
from service.regex import regex

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
_TICK: Final = timedelta(microseconds=1)
# No number in a database is larger.
_LARGEST: Final = 2**62
_CURSOR: Final = regex(r"[0-9a-f]+\.[0-9a-f]+")


def condition(wanted: AttemptFilter) -> ColumnElement[bool]:
    """Return the SQL condition for the attempts that a filter selects."""
    return and_(True, *_conditions(wanted))


def _conditions(wanted: AttemptFilter) -> Iterator[ColumnElement[bool]]:
    if wanted.exercise is not None:
        exercise, _, seed = wanted.exercise.partition("~")
        yield attempts.c.exercise == exercise
        if seed:
            yield attempts.c.variant == seed
    if wanted.learner is not None:
        yield attempts.c.learner == wanted.learner
    if wanted.since is not None:
        yield attempts.c.at >= wanted.since
    if wanted.until is not None:
        yield attempts.c.at < wanted.until
    if wanted.course is not None:
        mine = select(assignments.c.number).where(assignments.c.course == wanted.course)
        if wanted.assignment is not None:
            mine = mine.where(assignments.c.id == wanted.assignment)
        yield attempts.c.assignment.in_(mine)
    if wanted.counted is not None:
        has_ordinal = attempts.c.ordinal.is_not(None)
        yield has_ordinal if wanted.counted else ~has_ordinal


@dataclass(frozen=True, slots=True)
class AttemptHistory:
    """An attempt with all its records; ``submission`` and ``report`` are JSON.

    ``course`` is the course of the attempt's assignment, or None.
    """

    attempt: ListedAttempt
    submission: str
    report: str
    overrides: Sequence[Row[Any]]
    earlier: Sequence[Row[Any]]
    course: str | None
    hints: Sequence[TakenHint] = ()


LISTED: Final = [attempts.c[name] for name in ListedAttempt.__dataclass_fields__]


def page(
    connection: Connection, wanted: AttemptFilter, cursor: str | None, most: int
) -> tuple[list[ListedAttempt], str | None]:
    """Return at most ``most`` attempts, the newest first, and the cursor of the next page, if any.

    Raises BadCursorError.
    """
    newest = select(*LISTED).where(condition(wanted))
    if cursor is not None:
        newest = newest.where(earlier_than(place_of(cursor)))
    newest = newest.order_by(attempts.c.at.desc(), attempts.c.number.desc()).limit(most + 1)
    found = [ListedAttempt(**row._mapping) for row in connection.execute(newest)]
    if len(found) <= most:
        return found, None
    shown = found[:most]
    return shown, cursor_of((shown[-1].at, shown[-1].number))


def history(connection: Connection, attempt_id: str) -> AttemptHistory | None:
    """Return an attempt with its answers, reports and overrides; None if the id is unknown."""
    # PostgreSQL raises an error for some characters.
    if not attempt_id.isalnum():
        return None
    found = connection.execute(
        select(*LISTED, attempts.c.submission, attempts.c.report, assignments.c.course)
        .join_from(attempts, assignments, isouter=True)
        .where(attempts.c.id == attempt_id)
    ).one_or_none()
    if found is None:
        return None
    *listed, submission, report, course = found
    attempt = ListedAttempt(*listed)
    changed, replaced = (
        connection.execute(
            select(table).where(table.c.attempt == attempt.number).order_by(table.c.id)
        ).all()
        for table in (overrides, earlier_reports)
    )
    hints = hints_before(connection, attempt_id)
    return AttemptHistory(attempt, submission, report, changed, replaced, course, hints)


# The place of an attempt in time: its moment, and its number among attempts of the same moment.
TimePlace = tuple[datetime, int]
BY_TIME: Final = (attempts.c.at, attempts.c.number)


def earlier_than(place: TimePlace) -> ColumnElement[bool]:
    """Return the SQL condition for attempts before this time and number."""
    return tuple_(*BY_TIME) < _literal(place)


def later_than(place: TimePlace) -> ColumnElement[bool]:
    """Return the SQL condition for attempts after this time and number."""
    return tuple_(*BY_TIME) > _literal(place)


def _literal(place: TimePlace) -> Tuple:
    at, number = place
    return tuple_(literal(at, UtcTime()), literal(number))


def cursor_of(place: TimePlace) -> str:
    """Write the time and number of an attempt as the cursor of a page."""
    at, number = place
    return f"{(at - _EPOCH) // _TICK:x}.{number:x}"


def place_of(cursor: str) -> TimePlace:
    """Read the time and number of an attempt from a cursor. Raises BadCursorError."""
    if not _CURSOR.fullmatch(cursor):
        raise BadCursorError(cursor)
    try:
        ticks, number = (int(part, 16) for part in cursor.split("."))
        if number >= _LARGEST:
            raise BadCursorError(cursor)
        return _EPOCH + ticks * _TICK, number
    except OverflowError as error:  # after the year 9999
        raise BadCursorError(cursor) from error
