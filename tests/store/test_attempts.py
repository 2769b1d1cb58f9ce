"""Test how attempts are recorded, and which of them counts."""

import asyncio
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime, timedelta, timezone

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.store import (
    AttemptRefusedError,
    NewAttempt,
    Outcome,
    RecordedAttempt,
    Ruling,
    Standing,
    StoreDownError,
    UnknownAttemptError,
    UnusableDatabaseError,
    UnusablePointsError,
    points_after,
    ruling,
)
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import open_database
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import LearnerData, forget, history, override
from dh_grader.store.tables import attempts, metadata, outcomes, regrade_queue
from pydantic import ValidationError
from sqlalchemy import func, select, text

from tests.guards import ANSWER
from tests.store.recorded import NO_TWIST, NOON, RIGHT, record_once, recorded, regraded

OUTCOME = Outcome("scara", "{}")
NEW = NewAttempt(
    exercise="scara",
    learner="ada",
    ordinal=1,
    at=datetime(2026, 11, 22, 12, tzinfo=UTC),
    is_late=False,
    worth=1.0,
    submission='{"answers": {"table": "\\u0000 θ"}}',
    answers_digest="a",
    report="{}",
    version="1",
    grader="0.1",
    points=3.5,
    max_points=8,
    owner="",
    idempotency_key=None,
    request_digest="r",
)


def record(store: AttemptStore, new: NewAttempt) -> RecordedAttempt | None:
    return asyncio.run(record_once(store, new, OUTCOME))


def test_the_tables_are_those_that_the_migrations_make(database_url: str) -> None:
    engine = open_database(database_url)
    with engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), metadata) == []
    engine.dispose()


def test_an_attempt_is_found_again_as_it_was_written(store: AttemptStore) -> None:
    written = record(store, replace(NEW, idempotency_key="k"))
    assert written is not None
    found = asyncio.run(store.standing("scara", "ada", "", "k"))
    assert found.counted == 1
    assert found.earlier == written
    assert written.at == NEW.at
    assert written.submission == NEW.submission


def test_each_ordinal_and_each_key_is_used_once(store: AttemptStore) -> None:
    assert record(store, replace(NEW, idempotency_key="k"))
    assert record(store, NEW) is None
    assert record(store, replace(NEW, ordinal=2, idempotency_key="k")) is None
    assert record(store, replace(NEW, ordinal=2, idempotency_key="k", owner="another"))
    assert record(store, replace(NEW, learner="grace"))


def test_uncounted_attempts_use_no_ordinal(store: AttemptStore) -> None:
    for _ in range(3):
        assert record(store, replace(NEW, ordinal=None))
    assert asyncio.run(store.standing("scara", "ada", "", None)).counted == 0


def test_only_one_of_many_concurrent_attempts_gets_the_ordinal(database_url: str) -> None:
    stores = [AttemptStore.open(database_url) for _ in range(2)]
    for store in stores:
        store.start()
    with ThreadPoolExecutor(8) as pool:
        written = list(pool.map(lambda i: record(stores[i % 2], NEW), range(24)))
    for store in stores:
        store.close()
    assert sum(each is not None for each in written) == 1


def test_concurrent_attempts_get_consecutive_ordinals(database_url: str) -> None:
    stores = [AttemptStore.open(database_url) for _ in range(2)]

    def after(standing: Standing) -> tuple[NewAttempt, Outcome] | None:
        ordinal = standing.counted + 1
        return (replace(NEW, ordinal=ordinal), OUTCOME) if ordinal <= 20 else None

    for store in stores:
        store.start()
    with ThreadPoolExecutor(8) as pool:
        begun = Standing(0, None)
        results = list(
            pool.map(lambda i: asyncio.run(stores[i % 2].record(begun, after)), range(24))
        )
    for store in stores:
        store.close()
    written = [each.ordinal for each in results if isinstance(each, RecordedAttempt)]
    assert sorted(written) == list(range(1, 21))  # type: ignore[type-var]
    refused = [each for each in results if isinstance(each, Standing)]
    assert refused == [Standing(20, None, last=20)] * 4


def test_a_failing_job_does_not_affect_others(store: AttemptStore) -> None:
    broken = replace(NEW, learner="x" * 10, submission=None)  # type: ignore[arg-type]

    async def together() -> list[object]:
        jobs = [
            record_once(store, replace(NEW, learner=str(i)) if i != 3 else broken, OUTCOME)
            for i in range(8)
        ]
        return list(await asyncio.gather(*jobs, return_exceptions=True))

    results = asyncio.run(together())
    assert isinstance(results[3], StoreDownError)
    assert sum(isinstance(each, RecordedAttempt) for each in results) == 7


def test_a_failed_write_is_reported_and_the_next_one_works(store: AttemptStore) -> None:
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE attempts RENAME TO hidden"))
    with pytest.raises(StoreDownError):
        record(store, NEW)
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE hidden RENAME TO attempts"))
    assert record(store, NEW)


@pytest.mark.parametrize(
    "url",
    [
        "mysql://a:secret@host/b",
        "/no/such/folder/a.db",
        "postgresql://u:secret@127.0.0.1:1/x",
        "postgresql://u:secret@:bad/x",
        "sqlite+foo:///x",
        "sqlite+aiosqlite:///x",
        "sqlite:///x?timeout=secret",
        ":memory:",
        "sqlite://",
        "sqlite:///file::memory:?uri=true",
    ],
)
def test_an_unusable_database_is_named_without_its_password(url: str) -> None:
    with pytest.raises(UnusableDatabaseError) as refused:
        open_database(url)
    assert "secret" not in str(refused.value)


# --- Policy

POLICY_NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)
HOUR = timedelta(hours=1)


def refusal(rules: AttemptsSpec, counted: int, now: datetime) -> str:
    with pytest.raises(AttemptRefusedError) as refused:
        ruling(rules, counted, now)
    return refused.value.name


def test_without_rules_every_attempt_is_taken() -> None:
    assert ruling(AttemptsSpec(), 1000, POLICY_NOON) == Ruling(1001, is_late=False, worth=1.0)


def test_the_last_attempt_is_taken_and_no_further_one() -> None:
    rules = AttemptsSpec(limit=3)
    assert ruling(rules, 2, POLICY_NOON).ordinal == 3
    assert refusal(rules, 3, POLICY_NOON) == "no-attempts-left"


def test_attempts_exactly_at_opening_and_due_are_in_time() -> None:
    rules = AttemptsSpec(opens=POLICY_NOON, due=POLICY_NOON + HOUR)
    assert refusal(rules, 0, POLICY_NOON - timedelta(microseconds=1)) == "not-open"
    assert ruling(rules, 0, POLICY_NOON).worth == 1
    assert not ruling(rules, 0, POLICY_NOON + HOUR).is_late
    assert refusal(rules, 0, POLICY_NOON + HOUR + timedelta(microseconds=1)) == "closed"


def test_a_late_attempt_earns_its_share_until_the_exercise_closes() -> None:
    rules = AttemptsSpec(due=POLICY_NOON, closes=POLICY_NOON + HOUR, late_worth=0.25)
    assert ruling(rules, 0, POLICY_NOON + HOUR) == Ruling(1, is_late=True, worth=0.25)
    assert refusal(rules, 0, POLICY_NOON + 2 * HOUR) == "closed"


@pytest.mark.parametrize(
    ("points", "price", "worth", "expected"),
    [
        (24, 0, 1, 24),
        (24, 0.25, 1, 18),
        # A late attempt earns its share of what is left.
        (24, 0.25, 0.5, 9),
        (4, 0.25, 1, 0),
        (24, 1.5, 1, 0),
    ],
)
def test_hints_reduce_the_points_before_lateness(
    points: float, price: float, worth: float, expected: float
) -> None:
    assert points_after(points, 24, price, worth) == expected


def test_moments_of_other_zones_are_compared_as_moments() -> None:
    in_berlin = POLICY_NOON.astimezone(timezone(HOUR))
    assert refusal(AttemptsSpec(opens=in_berlin + HOUR), 0, POLICY_NOON) == "not-open"


@pytest.mark.parametrize(
    "wrong",
    [
        {"opens": datetime(2026, 11, 22, 12)},  # noqa: DTZ001 - the missing zone is the fault
        {"closes": POLICY_NOON},
        {"due": POLICY_NOON, "closes": POLICY_NOON - HOUR},
        {"limit": 0},
        {"late_worth": 1.5},
        {"hint_prices": [0, 0.1]},
        {"hint_prices": [0, 0.1, 1.5]},
        {"hint_prices": [0, -0.1, 0]},
    ],
)
def test_rules_that_make_no_sense_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        AttemptsSpec.model_validate(wrong)


# --- Tutoring


def test_points_of_a_tutor_count_and_can_be_withdrawn(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    attempt = recorded(store, catalogue["scara"], "ada", NO_TWIST)
    earned = []
    for points, reason in ((5.0, "the sheet was wrong"), (None, "it was not")):
        with store.engine.execution_options(writes=True).begin() as connection:
            override(connection, attempt.id, points, reason, "Dr. Lee", NOON)
            found = history(connection, attempt.id)
        assert found is not None
        earned.append(found.attempt.earned)
    assert earned == [5.0, attempt.points]
    with store.engine.connect() as connection:
        found = history(connection, attempt.id)
    assert found is not None
    told = [(row.points, row.reason, row.author, row.at) for row in found.overrides]
    assert told == [
        (5.0, "the sheet was wrong", "Dr. Lee", NOON),
        (None, "it was not", "Dr. Lee", NOON),
    ]


def test_points_out_of_range_are_refused(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    attempt = recorded(store, catalogue["scara"], "ada", NO_TWIST)
    for points in (-0.5, 1000.0, float("nan")):
        with (
            store.engine.execution_options(writes=True).begin() as connection,
            pytest.raises(UnusablePointsError),
        ):
            override(connection, attempt.id, points, "", "", NOON)
    with (
        store.engine.execution_options(writes=True).begin() as connection,
        pytest.raises(UnknownAttemptError),
    ):
        override(connection, "0" * 32, 1.0, "", "", NOON)


def test_nothing_of_a_forgotten_learner_is_left(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    first = recorded(store, scara, "ada", NO_TWIST)
    recorded(store, scara, "ada", RIGHT, 2)
    other = recorded(store, scara, "grace", RIGHT)
    regrading = Regrading(replace(scara, version="2"), FeedbackLevel.FULL)
    regraded(store, regrading)
    with store.engine.execution_options(writes=True).begin() as connection:
        override(connection, first.id, 1.0, "because", "me", NOON)
        connection.execute(regrade_queue.insert().values(attempt=first.number, exercise="scara"))
    with store.engine.execution_options(writes=True).begin() as connection:
        assert forget(connection, "ada") == LearnerData(2, 2, 1, 0)
        assert forget(connection, "ada") == LearnerData(0, 0, 0, 0)
    with store.engine.connect() as connection:
        assert list(connection.scalars(select(attempts.c.id))) == [other.id]
        for table in metadata.tables.values():
            if table not in (attempts, outcomes):
                rows = connection.scalar(select(func.count()).select_from(table)) or 0
                assert rows == (1 if table.name == "earlier_reports" else 0)


def test_a_learner_can_be_forgotten_while_a_regrade_begins(
    postgresql_url: str, catalogue: Mapping[str, Exercise]
) -> None:
    store = AttemptStore.open(postgresql_url)
    recorded(store, catalogue["scara"], "ada", NO_TWIST)
    regrading = Regrading(replace(catalogue["scara"], version="2"), FeedbackLevel.FULL)

    def forgotten() -> LearnerData:
        with store.engine.execution_options(writes=True).begin() as connection:
            return forget(connection, "ada")

    waiting = text("SELECT count(*) FROM pg_stat_activity WHERE wait_event_type = 'Lock'")
    with ThreadPoolExecutor(1) as thread:
        with store.engine.execution_options(writes=True).begin() as connection:
            regrading.enqueue(connection)
            deleted = thread.submit(forgotten)
            end = time.monotonic() + ANSWER
            with store.engine.connect() as watching:
                while not watching.scalar(waiting) and time.monotonic() < end:
                    # Within one transaction the view would not change.
                    watching.rollback()
                    time.sleep(0.01)
        assert deleted.result(ANSWER) == LearnerData(1, 0, 0, 0)
    with store.engine.connect() as connection:
        assert regrading.waiting(connection) == 0
    store.close()
