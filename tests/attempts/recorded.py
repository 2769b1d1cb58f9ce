"""Record attempts for tests."""

from collections.abc import Iterable
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.contract import AttemptRequest
from dh_grader.store import (
    AttemptGrading,
    AttemptReport,
    NewAttempt,
    Outcome,
    RecordedAttempt,
    Standing,
)
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.attempts import record
from dh_grader.store.database import in_transaction
from dh_grader.store.regrades import RegradedAttempt, Regrading

NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)
RIGHT = "a1 0 0 θ1\na2 180deg 0 θ2\n0 0 d3 0\n0 0 d4 θ4"
NO_TWIST = "a1 0 0 θ1\na2 0 0 θ2\n0 0 d3 0\n0 0 d4 θ4"
LAZY = "0 0 0 θ1\n0 0 0 θ2\n0 0 d3 0\n0 0 0 θ4"


async def record_once(
    store: AttemptStore, new: NewAttempt, outcome: Outcome
) -> RecordedAttempt | None:
    before = Standing(0, None)
    written = await store.record(
        before, lambda standing: (new, outcome) if standing is before else None
    )
    return written if isinstance(written, RecordedAttempt) else None


def recorded(
    store: AttemptStore, exercise: Exercise, learner: str, table: str, *given: Any, **more: Any
) -> RecordedAttempt:
    (written,) = recorded_all(store, [new_attempt(exercise, learner, table, *given, **more)])
    return written


def recorded_all(
    store: AttemptStore, new: Iterable[tuple[NewAttempt, Outcome]]
) -> list[RecordedAttempt]:
    with store.engine.connect() as connection:
        connection = connection.execution_options(writes=True)
        with connection.begin():
            written = [record(connection, *each) for each in new]
    assert None not in written
    return [each for each in written if each]


_MEMOIZED: dict[tuple[str, ...], AttemptReport] = {}


def _graded(exercise: Exercise, body: AttemptRequest, level: FeedbackLevel) -> AttemptReport:
    key = (exercise.id, exercise.version, body.answers["table"], level)
    if key not in _MEMOIZED:
        _MEMOIZED[key] = AttemptGrading(exercise, body).at(level)
    return _MEMOIZED[key]


def new_attempt(
    exercise: Exercise,
    learner: str,
    table: str,
    ordinal: int | None = 1,
    hours: float = 0,
    **more: Any,
) -> tuple[NewAttempt, Outcome]:
    """Return an attempt at the exercise."""
    body = AttemptRequest(learner=learner, answers={"table": table})
    graded = _graded(exercise, body, exercise.feedback_at(ordinal or 1))
    report = graded.report
    new = NewAttempt(
        exercise=exercise.id,
        learner=learner,
        ordinal=ordinal,
        at=NOON + timedelta(hours=hours),
        is_late=False,
        worth=1.0,
        submission=body.model_dump_json(exclude={"learner"}, exclude_unset=True),
        answers_digest=str(hash(table)),
        report=graded.text,
        version=report.version,
        grader=report.grader,
        points=report.points,
        max_points=report.max_points,
        owner="",
        idempotency_key=None,
        request_digest="",
    )
    return replace(new, **more), graded.outcome


def regraded(store: AttemptStore, regrading: Regrading) -> list[RegradedAttempt]:
    in_transaction(store.engine, regrading.enqueue)
    done: list[RegradedAttempt] = []
    while in_transaction(store.engine, regrading.waiting):
        done += regrading.next_batch(store.engine)
    return done
