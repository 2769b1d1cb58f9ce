"""Record and erase attempts for tests."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
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
from dh_grader.store.database import in_transaction, open_database
from dh_grader.store.regrades import RegradedAttempt, Regrading

# --- Record attempts for tests

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


# --- Search the files of an SQLite database for a text


def files_with(text: str, path: str) -> list[str]:
    name = Path(path).name
    found = Path(path).parent.glob(f"{name}*")
    return sorted(
        file.name.removeprefix(name) for file in found if text.encode() in file.read_bytes()
    )


@contextmanager
def reader(path: str) -> Iterator[None]:
    """Keep a second connection open that reads the database."""
    other = open_database(path, create=False)
    with other.connect() as connection:
        assert connection.exec_driver_sql("SELECT count(*) FROM attempts").scalar_one() >= 0
        yield
    other.dispose()
