"""The queue of scores to be sent to learning platforms.

A row belongs to a learner and a line item (a column of the platform's gradebook). Points are read
when they are sent, so the last change counts.
"""

import secrets
from datetime import UTC, datetime
from enum import IntEnum
from typing import Any, Final

from sqlalchemy import ColumnElement, Connection, bindparam, case, literal, select, update
from sqlalchemy.dialects import postgresql, sqlite

from service.attempts.storage.lti_tables import contexts, learners, line_items, scores
from service.attempts.storage.tables import UtcTime, attempts

# In ``Connection.info``: True if the transaction has queued a score.
QUEUED: Final = "scores_queued"
# How the learners of scores begin that are to be cleared.
FORGOTTEN: Final = "forgotten-"


class Priority(IntEnum):
    """The priority of a queued score; the lowest number is sent first."""

    HAND_IN = 0
    CHANGE = 1
    REGRADE = 2


_COLUMNS: Final = (
    "line_item", "learner", "sub", "max_points", "version", "wanted_at", "state", "priority",
    "tries", "next_try_at",
)  # fmt: skip
# Build the statements once: building one takes longer than running it.
_RECEIVERS: Final = (
    select(
        line_items.c.number,
        learners.c.learner,
        learners.c.sub,
        line_items.c.max_points,
        literal(1).label("version"),
        bindparam("now", type_=UtcTime).label("wanted_at"),
        literal("waiting").label("state"),
        bindparam("priority", type_=scores.c.priority.type).label("priority"),
        literal(0).label("tries"),
        bindparam("now", type_=UtcTime).label("next_try_at"),
    )
    .join_from(line_items, contexts)
    .join(learners, learners.c.registration == contexts.c.registration)
)
_OF_LEARNER: Final = _RECEIVERS.where(
    line_items.c.assignment == bindparam("assignment"), learners.c.learner == bindparam("learner")
)


def _upsert(dialect: Any, chosen: Any) -> Any:
    new = dialect.insert(scores).from_select(_COLUMNS, chosen)
    more_urgent = case(
        (
            (scores.c.state == "waiting") & (scores.c.priority < new.excluded.priority),
            scores.c.priority,
        ),
        else_=new.excluded.priority,
    )
    return new.on_conflict_do_update(
        index_elements=[scores.c.line_item, scores.c.learner],
        set_={
            "sub": new.excluded.sub,
            "version": scores.c.version + 1,
            "wanted_at": new.excluded.wanted_at,
            "state": "waiting",
            "priority": more_urgent,
            "next_try_at": new.excluded.next_try_at,
        },
    )


_DIALECTS: Final = {"postgresql": postgresql, "sqlite": sqlite}
_QUEUE_ONE: Final = {name: _upsert(each, _OF_LEARNER) for name, each in _DIALECTS.items()}


def queue_score(
    connection: Connection, assignment: int | None, learner: str, priority: Priority
) -> None:
    """Queue the score of a learner in an assignment, if a platform has a column for this score."""
    if assignment is not None:
        _queue(
            connection,
            _QUEUE_ONE[connection.dialect.name],
            priority,
            assignment=assignment,
            learner=learner,
        )


def queue_scores(
    connection: Connection, chosen: ColumnElement[bool], priority: Priority = Priority.CHANGE
) -> None:
    """Queue the scores of the chosen attempts; ``chosen`` is an SQL condition."""
    having = select(attempts.c.assignment, attempts.c.learner).where(
        chosen, attempts.c.assignment.is_not(None)
    )
    having_them = having.distinct().subquery()
    receivers = _RECEIVERS.join(
        having_them,
        (having_them.c.assignment == line_items.c.assignment)
        & (having_them.c.learner == learners.c.learner),
    )
    # SQLite reads "ON CONFLICT" after a join as a part of the join, unless there is a WHERE.
    receivers = receivers.where(line_items.c.number.is_not(None))
    _queue(connection, _upsert(_DIALECTS[connection.dialect.name], receivers), priority)


def forget_scores(connection: Connection, learner: str) -> None:
    """Delete a learner's scores: at the platforms if they were sent, else in the queue."""
    mine = scores.c.learner == learner
    connection.execute(scores.delete().where(mine, scores.c.stamp.is_(None)))
    # The platform's id of the learner stays until the platform has cleared the score.
    now = datetime.now(UTC)
    left = update(scores).where(mine)
    changed = connection.execute(
        left.values(
            learner=FORGOTTEN + secrets.token_hex(16),
            version=scores.c.version + 1,
            points=None,
            submitted_at=None,
            wanted_at=now,
            state="waiting",
            priority=int(Priority.CHANGE),
            next_try_at=now,
            refusal=None,
        )
    )
    if changed.rowcount:
        connection.info[QUEUED] = True


def _queue(connection: Connection, statement: Any, priority: Priority, **more: object) -> None:
    values = {"now": datetime.now(UTC), "priority": int(priority), **more}
    if connection.execute(statement, values).rowcount:
        connection.info[QUEUED] = True
