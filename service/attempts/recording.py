"""Record each attempt exactly once, under the learner's next number."""

import secrets
from collections.abc import Callable, Iterable
from typing import Any, Final

from sqlalchemy import Connection, Table, and_, bindparam, func, select
from sqlalchemy.dialects import postgresql, sqlite

from service.attempts.attempt import NewAttempt, RecordedAttempt, Standing
from service.attempts.hints import price_so_far
from service.attempts.outcome import Outcome
from service.attempts.storage.score_queue import Priority, queue_score
from service.attempts.storage.tables import attempts, outcomes

# Build the statements once: building one takes longer than running it.
_WRITTEN: Final = tuple(NewAttempt.__dataclass_fields__)
_EARLIER: Final = select(
    *(attempts.c[name] for name in RecordedAttempt.__dataclass_fields__)
).where(
    attempts.c.owner == bindparam("owner"),
    attempts.c.idempotency_key == bindparam("idempotency_key"),
)
_OF_LEARNER: Final = and_(
    attempts.c.exercise == bindparam("exercise"), attempts.c.learner == bindparam("learner")
)
_LAST: Final = select(
    func.max(attempts.c.ordinal).label("last"), func.count(attempts.c.ordinal).label("number")
).where(_OF_LEARNER)
_ASSIGNED: Final = (
    select(attempts.c.assignment, func.count(attempts.c.ordinal).label("tried"))
    .where(_OF_LEARNER, attempts.c.assignment.is_not(None))
    .group_by(attempts.c.assignment)
)
_OUTCOME: Final = select(outcomes.c.id).where(
    outcomes.c.exercise == bindparam("exercise"), outcomes.c.digest == bindparam("digest")
)
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


_NEW_OUTCOME: Final = insert_or_ignore(outcomes)
_NEW_ATTEMPT: Final = {
    kind: statement.returning(attempts.c.number)
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
    """Return how many attempts of a learner count, and the attempt with this idempotency key.

    Attempts count in the assignment, or, without one, outside of all assignments.
    """
    earlier = None
    if idempotency_key is not None:
        key = {"owner": owner, "idempotency_key": idempotency_key}
        found = connection.execute(_EARLIER, key).one_or_none()
        earlier = RecordedAttempt(**found._mapping) if found else None
    which = {"exercise": exercise, "learner": learner}
    # Deleted attempts leave gaps in the ordinals.
    all_ = connection.execute(_LAST, which).one()
    assigned = {row.assignment: row.tried for row in connection.execute(_ASSIGNED, which)}
    outside = all_.number - sum(assigned.values())
    counted = outside if assignment is None else assigned.get(assignment, 0)
    price = price_so_far(connection, exercise, learner, assignment)
    return Standing(counted, earlier, all_.last or 0, price)


def record(connection: Connection, new: NewAttempt, outcome: Outcome) -> RecordedAttempt | None:
    """Write the attempt; return None if its ordinal or its key has been taken in the meantime."""
    values: dict[str, Any] = {name: getattr(new, name) for name in _WRITTEN}
    values["id"] = secrets.token_hex(16)
    number = connection.scalar(
        _NEW_ATTEMPT[connection.dialect.name],
        values | {"outcome": _outcome_id(connection, outcome)},
    )
    if number is None:
        return None
    if new.ordinal is not None:
        queue_score(connection, new.assignment, new.learner, Priority.HAND_IN)
    return RecordedAttempt(**values, number=number)


# Returns the next attempt after a standing, or None if none is allowed or prepared.
AttemptAfter = Callable[[Standing], tuple[NewAttempt, Outcome] | None]


def record_next(
    connection: Connection, before: Standing, attempt_after: AttemptAfter
) -> RecordedAttempt | Standing:
    """Write the attempt that ``attempt_after`` returns; if another came first, ask it again.

    Return the current standing instead if ``attempt_after`` returns None.
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
    """Return the row ids of the outcomes, after inserting those that are new."""
    # Always in the same order: otherwise two workers could deadlock.
    ordered = sorted(set(wanted), key=lambda each: (each.exercise, each.digest))
    ids = _written_outcomes(connection, ordered)
    if new := [each for each in ordered if each not in ids]:
        rows = [{"content": each.content} | _key(each) for each in new]
        connection.execute(_NEW_OUTCOME[connection.dialect.name], rows)
        ids |= _written_outcomes(connection, new)
    return ids


def _written_outcomes(connection: Connection, wanted: Iterable[Outcome]) -> dict[Outcome, int]:
    """Return the row ids of those outcomes that are already in the database."""
    by_digest = {(each.exercise, each.digest): each for each in wanted}
    exercises, digests = zip(*by_digest, strict=True)
    which = {"exercises": list(set(exercises)), "digests": list(digests)}
    found = connection.execute(_OUTCOMES, which)
    return {by_digest[exercise, digest]: row for row, exercise, digest in found}


def _key(outcome: Outcome) -> dict[str, str]:
    return {"exercise": outcome.exercise, "digest": outcome.digest}


def _outcome_id(connection: Connection, outcome: Outcome) -> int:
    key = _key(outcome)
    found = connection.scalar(_OUTCOME, key)
    if found is None:
        new = key | {"content": outcome.content}
        connection.execute(_NEW_OUTCOME[connection.dialect.name], new)
        found = connection.scalar(_OUTCOME, key)
    assert found is not None
    return int(found)
