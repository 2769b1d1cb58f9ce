"""Record each attempt exactly once, and number the attempts of each learner."""

import secrets
from collections.abc import Callable, Iterable
from typing import Any, Final

from sqlalchemy import (
    ColumnElement,
    Connection,
    Select,
    Table,
    and_,
    bindparam,
    delete,
    exists,
    false,
    func,
    insert,
    select,
    update,
)
from sqlalchemy.dialects import postgresql, sqlite

from service.attempts.attempt import NewAttempt, RecordedAttempt, Standing
from service.attempts.hints import PRICE
from service.attempts.outcome import Outcome
from service.attempts.storage.lti_tables import line_items
from service.attempts.storage.score_queue import Priority, queue_score
from service.attempts.storage.tables import attempts, outcomes

# Build the statements once: building one takes longer than running it.
_WRITTEN: Final = tuple(NewAttempt.__dataclass_fields__)
_RECORDED: Final = tuple(RecordedAttempt.__dataclass_fields__)
_EARLIER: Final = select(*(attempts.c[name] for name in _RECORDED)).where(
    attempts.c.number == bindparam("number")
)
_OF_LEARNER: Final = and_(
    attempts.c.exercise == bindparam("exercise"), attempts.c.learner == bindparam("learner")
)
_ALL: Final = func.count(attempts.c.ordinal)


def _standing(counted: ColumnElement[int]) -> Select[Any]:
    earlier = select(attempts.c.number).where(
        attempts.c.owner == bindparam("owner"),
        attempts.c.idempotency_key == bindparam("idempotency_key"),
    )
    # Deleted attempts leave gaps in the ordinals.
    last = func.coalesce(func.max(attempts.c.ordinal), 0)
    columns = (
        last.label("last"),
        counted.label("counted"),
        earlier.label("earlier"),
        PRICE.label("hint_price"),
    )
    return select(*columns).where(_OF_LEARNER)


def _counted(assigned: ColumnElement[bool]) -> ColumnElement[int]:
    return select(_ALL).where(_OF_LEARNER, assigned).scalar_subquery()


_IN_ASSIGNMENT: Final = _standing(_counted(attempts.c.assignment == bindparam("assignment")))
_OUTSIDE: Final = _standing(_ALL - _counted(attempts.c.assignment.is_not(None)))
_OUTCOMES: Final = select(outcomes.c.id, outcomes.c.exercise, outcomes.c.digest).where(
    outcomes.c.exercise.in_(bindparam("exercises", expanding=True)),
    outcomes.c.digest.in_(bindparam("digests", expanding=True)),
)


def insert_or_ignore(table: Table) -> dict[str, postgresql.Insert | sqlite.Insert]:
    """Return INSERT statements that skip conflicting rows, by the name of the SQL dialect."""
    return {
        "postgresql": postgresql.insert(table).on_conflict_do_nothing(),
        "sqlite": sqlite.insert(table).on_conflict_do_nothing(),
    }


def _as_written(name: str) -> ColumnElement[Any]:
    return bindparam(name, type_=attempts.c[name].type)


# An attempt gets the row of its outcome; if there is none, nothing is written. ``is_sent`` is true
# if a platform has a line item for the score.
_OF_OUTCOME: Final = select(
    *(_as_written(name) for name in (*_WRITTEN, "id")), outcomes.c.id.label("outcome")
).where(
    outcomes.c.exercise == bindparam("exercise"), outcomes.c.digest == bindparam("outcome_digest")
)
_NEW_OUTCOME: Final = insert_or_ignore(outcomes)
# Changes no row, but fails if the tables are missing or not writable.
_ALIVE: Final = update(attempts).values(number=attempts.c.number).where(false())
# What a rehearsal writes (bytes): an attempt takes 12 pages of 4 KiB, and more for long answers.
_REHEARSED: Final = 64 * 1024
_NEW_ATTEMPT: Final = {
    kind: statement.from_select((*_WRITTEN, "id", "outcome"), _OF_OUTCOME).returning(
        attempts.c.number,
        exists().where(line_items.c.assignment == bindparam("assignment")).label("is_sent"),
    )
    for kind, statement in insert_or_ignore(attempts).items()
}


def standing(
    connection: Connection,
    exercise: str,
    learner: str,
    owner: str,
    idempotency_key: str | None,
    assignment: int | None = None,
) -> Standing:
    """Return a summary of a learner's earlier attempts at an exercise."""
    which: dict[str, str | int | None] = {
        "exercise": exercise,
        "learner": learner,
        "owner": owner,
        "idempotency_key": idempotency_key,
        "assignment": assignment,
    }
    # Only attempts in the same assignment count or, without one, those outside of all assignments.
    statement = _OUTSIDE if assignment is None else _IN_ASSIGNMENT
    row = connection.execute(statement, which).one()
    found = row.earlier and connection.execute(_EARLIER, {"number": row.earlier}).one_or_none()
    earlier = RecordedAttempt(**found._mapping) if found else None
    return Standing(row.counted, earlier, row.last, float(row.hint_price))


def record(connection: Connection, new: NewAttempt, outcome: Outcome) -> RecordedAttempt | None:
    """Write the attempt; return None if its number or idempotency key is already taken."""
    values: dict[str, Any] = {name: getattr(new, name) for name in _WRITTEN}
    values["id"] = secrets.token_hex(16)
    statement = _NEW_ATTEMPT[connection.dialect.name]
    row = values | {"outcome_digest": outcome.digest}
    written = connection.execute(statement, row).one_or_none()
    if written is None and _add_outcome(connection, outcome):
        written = connection.execute(statement, row).one_or_none()
    if written is None:
        return None
    if new.ordinal is not None and written.is_sent:
        queue_score(connection, new.assignment, new.learner, Priority.HAND_IN)
    return RecordedAttempt(**values, number=written.number)


def fail_if_read_only(connection: Connection) -> None:
    """Raise SQLAlchemyError if the tables are missing or cannot be written; write nothing."""
    connection.execute(_ALIVE)


def rehearse(connection: Connection) -> None:
    """Write as much as an attempt needs, and delete it again.

    Raises SQLAlchemyError if attempts cannot be recorded, for example because the disk is full.
    """
    fail_if_read_only(connection)
    # SQLite overwrites what it deletes (``secure_delete``), so the commit writes all pages.
    row = {"exercise": "", "digest": secrets.token_hex(32), "content": "0" * _REHEARSED}
    connection.execute(insert(outcomes), row)
    written = and_(outcomes.c.exercise == "", outcomes.c.digest == row["digest"])
    connection.execute(delete(outcomes).where(written))


# Returns the next attempt after a standing, or None if none is allowed or prepared.
AttemptAfter = Callable[[Standing], tuple[NewAttempt, Outcome] | None]


def record_next(
    connection: Connection, before: Standing, attempt_after: AttemptAfter
) -> RecordedAttempt | Standing:
    """Call ``attempt_after`` with the learner's earlier attempts, and write its result.

    If the result is None, write nothing and return the earlier attempts.
    """
    now = before
    while (attempt := attempt_after(now)) is not None:
        new, outcome = attempt
        written = record(connection, new, outcome)
        if written is not None:
            return written
        # In each round an earlier job or another process has recorded an attempt.
        now = standing(
            connection, new.exercise, new.learner, new.owner, new.idempotency_key, new.assignment
        )
    return now


def outcome_ids(connection: Connection, wanted: Iterable[Outcome]) -> dict[Outcome, int]:
    """Return the row ids of the outcomes; insert those that the database does not have."""
    # Always in the same order: otherwise two workers could deadlock.
    ordered = sorted(set(wanted), key=lambda each: (each.exercise, each.digest))
    ids = _written_outcomes(connection, ordered)
    if new := [each for each in ordered if each not in ids]:
        rows = [{"content": each.content} | _key(each) for each in new]
        connection.execute(_NEW_OUTCOME[connection.dialect.name], rows)
        ids |= _written_outcomes(connection, new)
    return ids


def _written_outcomes(connection: Connection, wanted: Iterable[Outcome]) -> dict[Outcome, int]:
    by_digest = {(each.exercise, each.digest): each for each in wanted}
    exercises, digests = zip(*by_digest, strict=True)
    which = {"exercises": list(set(exercises)), "digests": list(digests)}
    found = connection.execute(_OUTCOMES, which)
    return {by_digest[exercise, digest]: row for row, exercise, digest in found}


def _key(outcome: Outcome) -> dict[str, str]:
    return {"exercise": outcome.exercise, "digest": outcome.digest}


def _add_outcome(connection: Connection, outcome: Outcome) -> bool:
    new = _key(outcome) | {"content": outcome.content}
    statement = _NEW_OUTCOME[connection.dialect.name].returning(outcomes.c.id)
    return connection.scalar(statement, new) is not None
