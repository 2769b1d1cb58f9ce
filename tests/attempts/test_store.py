import asyncio
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from dh_grader.store import (
    NewAttempt,
    Outcome,
    RecordedAttempt,
    Standing,
    StoreDownError,
    UnusableDatabaseError,
)
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import open_database
from dh_grader.store.tables import metadata
from sqlalchemy import text

from tests.attempts.recorded import record_once

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
