"""Test how the writer thread groups its work into transactions."""

import asyncio
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from dh_grader.store import database as module
from dh_grader.store.database import AttemptWriter, open_database
from sqlalchemy import Connection, Engine, event

from tests.guards import ANSWER


@pytest.fixture
def engine(tmp_path: Path) -> Iterator[Engine]:
    engine = open_database(str(tmp_path / "attempts.db"))
    yield engine
    engine.dispose()


@pytest.fixture
def commits(engine: Engine) -> list[Connection]:
    counted: list[Connection] = []
    event.listen(engine, "commit", counted.append)
    return counted


def nothing(_: Connection) -> None:
    pass


def test_after_concurrent_jobs_the_next_one_waits_for_others(
    engine: Engine, commits: list[Connection], monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, all_wait = threading.Event(), threading.Event()
    gathering, last_waits = threading.Event(), threading.Event()

    def gather(_: float) -> None:
        gathering.set()
        assert last_waits.wait(ANSWER)

    def hold(_: Connection) -> None:
        begun.set()
        assert all_wait.wait(ANSWER)

    async def send() -> None:
        first = asyncio.create_task(writer.run(hold))
        assert await asyncio.to_thread(begun.wait, ANSWER)
        at_once = [asyncio.create_task(writer.run(nothing)) for _ in range(2)]
        await asyncio.sleep(0)
        all_wait.set()
        await asyncio.gather(first, *at_once)
        later = asyncio.create_task(writer.run(nothing))
        assert await asyncio.to_thread(gathering.wait, ANSWER)
        last = asyncio.create_task(writer.run(nothing))
        await asyncio.sleep(0)
        last_waits.set()
        await asyncio.gather(later, last)

    monkeypatch.setattr(module, "sleep", gather)
    writer = AttemptWriter(engine)
    try:
        asyncio.run(send())
    finally:
        writer.close()
    assert len(commits) == 3


def test_a_client_that_sends_one_job_after_the_other_never_waits(
    engine: Engine, commits: list[Connection], monkeypatch: pytest.MonkeyPatch
) -> None:
    gathered: list[float] = []

    async def send() -> None:
        for _ in range(5):
            await writer.run(nothing)

    monkeypatch.setattr(module, "sleep", gathered.append)
    writer = AttemptWriter(engine)
    try:
        asyncio.run(send())
    finally:
        writer.close()
    assert gathered == []
    assert len(commits) == 5
