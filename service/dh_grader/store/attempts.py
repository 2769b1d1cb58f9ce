"""Record attempts and the hints that learners take in the database, each exactly once.

What is read from recorded attempts is in ``results.py``; threads are in ``attempt_store.py``.
"""

import secrets
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
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

from dh_grader.contract import HintFigures, TakenHint
from dh_grader.store import NewAttempt, Outcome, RecordedAttempt, Standing
from dh_grader.store.database import Priority, queue_score
from dh_grader.store.tables import assignments, attempts, hints, line_items, outcomes
from dh_grader.translations import say

# --- The hints that learners take at recorded attempts
#
# A hint explains a message of a report. Its price reduces the points of the learner's later
# attempts at the exercise.


# What the learner's hints cost the next attempt, as a share of its points: a part of a statement
# that runs at every hand-in.
PRICE: Final = (
    select(func.coalesce(func.sum(hints.c.price), 0.0))
    .join_from(hints, attempts)
    .where(
        attempts.c.exercise == bindparam("exercise"),
        attempts.c.learner == bindparam("learner"),
        attempts.c.assignment.is_not_distinct_from(bindparam("assignment")),
    )
    .correlate(None)
    .scalar_subquery()
)
_TAKEN: Final = select(hints, attempts.c.id.label("attempt_id")).join_from(hints, attempts)


class HintRefusedError(Exception):
    """The hint is refused. The message is for the learner; ``name`` identifies the reason."""

    def __init__(self, name: str, message: str) -> None:
        self.name = name
        super().__init__(message)


@dataclass(frozen=True, slots=True)
class HintStepOf:
    """One step (sentence) of the hint for a message of a report."""

    part: str
    code: str
    # The place of the message; "" if the message is not about a row or a cell.
    row: str
    cell: str
    step: int


def attempt_with_course(connection: Connection, attempt_id: str) -> Row[Any] | None:
    """Return an attempt with the ids of its course and assignment, if any; None if unknown."""
    # PostgreSQL raises an error for some characters.
    if not attempt_id.isalnum():
        return None
    return connection.execute(
        select(
            attempts,
            assignments.c.course,
            assignments.c.choices,
            assignments.c.id.label("in_assignment"),
        )
        .join_from(attempts, assignments, isouter=True)
        .where(attempts.c.id == attempt_id)
    ).one_or_none()


def take(
    connection: Connection,
    attempt_id: str,
    wanted: HintStepOf,
    prices: Sequence[float],
    now: datetime,
) -> HintRefusedError | None:
    """Record that a learner took one step of a hint. Return an error if the step is refused."""
    # Two requests for the same step wait for each other.
    attempt = connection.execute(
        select(attempts).where(attempts.c.id == attempt_id).with_for_update()
    ).one()
    refused, is_taken = _ruling(connection, attempt, wanted)
    if refused is not None or is_taken:
        return refused
    values: dict[str, Any] = {name: getattr(wanted, name) for name in HintStepOf.__slots__}
    values |= {"attempt": attempt.number, "price": prices[wanted.step - 1], "at": now}
    connection.execute(insert(hints).values(values))
    return None


def hint_refusal(
    connection: Connection, attempt: Row[Any], wanted: HintStepOf
) -> HintRefusedError | None:
    """Return the error if this step of a hint is refused now, else None. Record nothing."""
    return _ruling(connection, attempt, wanted)[0]


def _ruling(
    connection: Connection, attempt: Row[Any], wanted: HintStepOf
) -> tuple[HintRefusedError | None, bool]:
    # The second value is True if the learner has taken the step before.
    # Steps are counted for each cell, row or part: another message there does not start them again.
    earlier = connection.execute(
        select(hints.c.step, hints.c.attempt, attempts.c.answers_digest)
        .join_from(hints, attempts)
        .where(
            _same_place(attempt),
            *(hints.c[name] == getattr(wanted, name) for name in ("part", "row", "cell")),
        )
        .order_by(hints.c.step)
    ).all()
    if wanted.step <= len(earlier):
        return None, True
    # Errors are not raised, because that would roll back other jobs of the transaction.
    if wanted.step > len(earlier) + 1:
        first = say("Take the earlier steps of this hint first.")
        return HintRefusedError("earlier-step-first", first), False
    if earlier and (
        earlier[-1].attempt >= attempt.number
        or earlier[-1].answers_digest == attempt.answers_digest
    ):
        change = say("Change your answer and hand it in again. Then the next hint opens.")
        return HintRefusedError("try-first", change), False
    return None, False


def hints_before(connection: Connection, attempt_id: str) -> list[TakenHint]:
    """Return the hints that the learner had taken before an attempt, oldest first."""
    attempt = connection.execute(select(attempts).where(attempts.c.id == attempt_id)).one()
    earlier = _TAKEN.where(
        _same_place(attempt), hints.c.attempt < attempt.number, hints.c.at <= attempt.at
    )
    return [_taken(row) for row in connection.execute(earlier.order_by(hints.c.id))]


def hints_of(connection: Connection, learner: str) -> dict[tuple[int, str], list[TakenHint]]:
    """Return a learner's hints by assignment number and exercise, the oldest first."""
    mine = _TAKEN.add_columns(attempts.c.assignment, attempts.c.exercise).where(
        attempts.c.learner == learner, attempts.c.assignment.is_not(None)
    )
    found: dict[tuple[int, str], list[TakenHint]] = {}
    for row in connection.execute(mine.order_by(hints.c.id)):
        found.setdefault((row.assignment, row.exercise), []).append(_taken(row))
    return found


def hint_figures(connection: Connection, chosen: ColumnElement[bool]) -> list[HintFigures]:
    """Count the hints taken at the chosen attempts, the most frequent first."""
    counted = (
        select(hints.c.part, hints.c.code, hints.c.step, func.count().label("times"))
        .join_from(hints, attempts)
        .where(chosen)
        .group_by(hints.c.part, hints.c.code, hints.c.step)
    )
    steps: dict[tuple[str, str], Counter[int]] = {}
    for row in connection.execute(counted):
        steps.setdefault((row.part, row.code), Counter())[row.step] = row.times
    ordered = sorted(steps.items(), key=lambda each: (-each[1].total(), each[0]))
    return [
        HintFigures(part=part, code=code, taken=[taken[step] for step in (1, 2, 3)])
        for (part, code), taken in ordered
    ]


def _same_place(attempt: Row[Any]) -> ColumnElement[bool]:
    return and_(
        attempts.c.exercise == attempt.exercise,
        attempts.c.learner == attempt.learner,
        attempts.c.assignment.is_not_distinct_from(attempt.assignment),
    )


def _taken(row: Row[Any]) -> TakenHint:
    return TakenHint(
        attempt=row.attempt_id,
        part=row.part,
        code=row.code,
        row=row.row or None,
        cell=row.cell or None,
        step=row.step,
        price=row.price,
        at=row.at,
    )


# --- Record each attempt exactly once, and number the attempts of each learner


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
