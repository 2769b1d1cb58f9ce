"""Test the health checks of a service with a real database."""

import asyncio
import logging
import threading
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.store import StoreDownError
from dh_grader.store.attempt_store import AttemptStore
from fastapi import FastAPI
from sqlalchemy import event, text

from tests.store.databases import new_file


@pytest.fixture
def store(tmp_path: Path) -> Iterator[AttemptStore]:
    store = AttemptStore.open(new_file(tmp_path))
    store.start()
    yield store
    store.close()


def asked(app: FastAPI, path: str, times: int = 1) -> list[httpx.Response]:
    async def ask() -> list[httpx.Response]:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await asyncio.gather(*(client.get(path) for _ in range(times)))

    return asyncio.run(ask())


def test_readiness_asks_the_database_once_for_all_and_liveness_never(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    app = application(catalogue, store=store)
    statements: list[Any] = []
    event.listen(store.engine, "before_cursor_execute", lambda *given: statements.append(given[2]))
    assert {answer.status_code for answer in asked(app, "/healthz", 20)} == {200}
    assert statements == []
    assert {answer.status_code for answer in asked(app, "/readyz", 20)} == {200}
    assert 1 <= len(statements) < 5


def test_readiness_writes_at_most_once_in_a_second(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    app = application(catalogue, store=store)
    writes: list[str] = []

    def note(_: Any, __: Any, statement: str, *___: Any) -> None:
        if statement.startswith("INSERT"):
            writes.append(statement)

    event.listen(store.engine, "before_cursor_execute", note)
    begun = time.monotonic()
    for _ in range(30):
        assert asked(app, "/readyz")[0].status_code == 200
    assert 1 <= len(writes) <= 1 + (time.monotonic() - begun)
    with store.engine.connect() as connection:
        assert connection.scalar(text("SELECT count(*) FROM outcomes")) == 0


def test_a_check_of_a_moment_ago_does_not_count_after_an_attempt_waited_in_vain(
    store: AttemptStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Here a success counts for long; normally it counts for a second.
    monkeypatch.setattr("dh_grader.store.attempt_store._CHECKED", 3600.0)
    reacts = threading.Event()

    async def wait_in_vain() -> None:
        await store.check()
        monkeypatch.setattr("dh_grader.store.database._TIMEOUT", 0.2)
        with pytest.raises(StoreDownError):
            await store.write(lambda _: reacts.wait())
        with pytest.raises(StoreDownError):
            await store.check()

    try:
        asyncio.run(wait_in_vain())
    finally:
        reacts.set()


def test_a_database_without_its_tables_is_not_ready_and_the_log_says_why(
    store: AttemptStore, catalogue: Mapping[str, Exercise], caplog: pytest.LogCaptureFixture
) -> None:
    app = application(catalogue, store=store)
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE attempts RENAME TO hidden"))
    with caplog.at_level(logging.WARNING):
        (answer,) = asked(app, "/readyz")
    assert answer.status_code == 503
    assert answer.json()["type"].endswith(":store-down")
    assert "no such table: attempts" in caplog.text
    assert asked(app, "/healthz")[0].status_code == 200


def test_a_service_without_exercises_is_not_ready() -> None:
    (answer,) = asked(application({}), "/readyz")
    assert answer.status_code == 503
    assert answer.json()["type"].endswith(":no-exercises")
