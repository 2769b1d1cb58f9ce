"""Recording an attempt: exactly once, and under the next number of its learner."""

import secrets
from dataclasses import asdict, dataclass
from datetime import datetime

from sqlalchemy import Connection, Table, func, select
from sqlalchemy.dialects import postgresql, sqlite

from service.attempts.outcome import Outcome
from service.attempts.tables import attempts, outcomes


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


def standing(
    connection: Connection, exercise: str, learner: str, owner: str, idempotency_key: str | None
) -> Standing:
    """How a learner stands at an exercise, and what a request with this key has recorded."""
    earlier = None
    if idempotency_key is not None:
        found = connection.execute(
            select(*_COLUMNS).where(
                attempts.c.owner == owner, attempts.c.idempotency_key == idempotency_key
            )
        ).one_or_none()
        earlier = RecordedAttempt(**found._mapping) if found else None
    counted = connection.scalar(
        select(func.max(attempts.c.ordinal)).where(
            attempts.c.exercise == exercise, attempts.c.learner == learner
        )
    )
    return Standing(counted or 0, earlier)


def record(connection: Connection, new: NewAttempt, outcome: Outcome) -> RecordedAttempt | None:
    """Write the attempt; None where another took its ordinal or its key in the meantime."""
    values = asdict(new) | {
        "id": secrets.token_hex(16),
        "outcome": outcome_id(connection, outcome),
    }
    written = connection.execute(
        insert_or_ignore(connection, attempts).values(values).returning(*_COLUMNS)
    ).one_or_none()
    return RecordedAttempt(**written._mapping) if written else None


_COLUMNS = [attempts.c[name] for name in RecordedAttempt.__dataclass_fields__]


def outcome_id(connection: Connection, outcome: Outcome) -> int:
    """The row of an outcome, written where it is new."""
    wanted = select(outcomes.c.id).where(
        outcomes.c.exercise == outcome.exercise, outcomes.c.digest == outcome.digest
    )
    found = connection.scalar(wanted)
    if found is None:
        values = {
            "exercise": outcome.exercise,
            "digest": outcome.digest,
            "content": outcome.content,
        }
        connection.execute(insert_or_ignore(connection, outcomes).values(values))
        found = connection.scalar(wanted)
    assert found is not None
    return int(found)


def insert_or_ignore(connection: Connection, table: Table) -> postgresql.Insert | sqlite.Insert:
    """INSERT that leaves out what another row stands in the way of."""
    if connection.dialect.name == "postgresql":
        return postgresql.insert(table).on_conflict_do_nothing()
    return sqlite.insert(table).on_conflict_do_nothing()
