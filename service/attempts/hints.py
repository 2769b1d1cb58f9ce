"""Database functions for the hints that learners take at recorded attempts.

A hint explains a message of a report. Its price reduces the points of the learner's later attempts
at the exercise.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import ColumnElement, Connection, Row, and_, bindparam, func, insert, select

from service.attempts.storage.tables import assignments, attempts, hints
from service.contract.attempts import TakenHint
from service.contract.statistics import HintFigures
from service.translations import say

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
