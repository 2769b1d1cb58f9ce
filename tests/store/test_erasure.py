"""Deleted data is in no file of an SQLite database any more."""

import random
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from itertools import count
from multiprocessing import Pipe
from pathlib import Path
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import (
    LARGE_LOG,
    LogCutter,
    in_transaction,
    open_database,
    overwrite_deleted,
)
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import forget, override
from sqlalchemy import Engine

from tests.guards import ANSWER
from tests.store.recorded import NOON, files_with, new_attempt, reader, recorded, recorded_all

WRITTEN = "q7777777"
TABLE = "a1 0 0 θ1\na2 0 0 {}\n0 0 d3 0\n0 0 d4 θ4"


def forgotten(engine: Engine, learner: str) -> bool | None:
    in_transaction(engine, lambda connection: forget(connection, learner))
    return overwrite_deleted(engine)


def until_erased(text: str, path: str) -> None:
    end = time.monotonic() + ANSWER
    while files_with(text, path):
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.mark.long
def test_deleted_data_stays_until_the_last_reader_ends(
    sqlite_url: str, catalogue: Mapping[str, Exercise]
) -> None:
    store = AttemptStore.open(sqlite_url)
    recorded(store, catalogue["scara"], "ada-4711", TABLE.format(WRITTEN))
    with reader(sqlite_url):
        assert forgotten(store.engine, "ada-4711") is False
        # The data is still in the file, as False says.
        assert files_with(WRITTEN, sqlite_url)
        LogCutter(store.engine).next()
        assert files_with(WRITTEN, sqlite_url)
        # Writers do not wait for the reader.
        recorded(store, catalogue["scara"], "grace", TABLE.format("θ2"))
    LogCutter(store.engine).next()
    assert files_with(WRITTEN, sqlite_url) == files_with("ada-4711", sqlite_url) == []
    assert files_with("grace", sqlite_url)
    store.close()


@pytest.mark.long
def test_a_running_store_finishes_the_erasure_of_another_program(
    sqlite_url: str, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("_INTERVAL", "_LOOK"):
        monkeypatch.setattr(f"dh_grader.store.database.{name}", 0.05)
    store = AttemptStore.open(sqlite_url)
    store.start()
    recorded(store, catalogue["scara"], "ada-4711", TABLE.format(WRITTEN))
    command = open_database(sqlite_url, create=False)
    with reader(sqlite_url):
        assert forgotten(command, "ada-4711") is False
        time.sleep(0.3)
        assert files_with(WRITTEN, sqlite_url)
    until_erased(WRITTEN, sqlite_url)
    assert files_with("ada-4711", sqlite_url) == []
    store.close()
    command.dispose()


def _read_until(path: str, over: Any) -> None:
    with reader(path):
        over.send("reading")
        over.recv()


def log_size(path: str) -> int:
    log = Path(f"{path}-wal")
    return log.stat().st_size if log.exists() else 0


@contextmanager
def long_reader(path: str, killable: Any) -> Iterator[None]:
    """Let another process read the database until the end of the context."""
    over, mine = Pipe()
    process = killable(target=_read_until, args=(path, over))
    process.start()
    assert mine.recv() == "reading"
    yield
    mine.send("over")
    process.join(ANSWER)
    assert process.exitcode == 0


@pytest.mark.long
def test_a_service_cuts_a_large_log_within_seconds_after_a_long_reader(
    sqlite_url: str, catalogue: Mapping[str, Exercise], killable: Any
) -> None:
    store = AttemptStore.open(sqlite_url)
    store.start()
    scara = catalogue["scara"]
    with long_reader(sqlite_url, killable):
        for number in count():
            new = [new_attempt(scara, f"{number}.{i}", TABLE.format("θ2")) for i in range(50)]
            recorded_all(store, new)
            if log_size(sqlite_url) > LARGE_LOG:
                break
    begun = time.monotonic()
    while log_size(sqlite_url):
        time.sleep(0.05)
    # It looks each second; the next regular truncation may be a minute away.
    assert time.monotonic() - begun < 40
    store.close()


@pytest.mark.long
def test_a_command_without_a_service_leaves_no_large_log_after_a_long_reader(
    sqlite_url: str, catalogue: Mapping[str, Exercise], killable: Any
) -> None:
    store = AttemptStore.open(sqlite_url)
    scara, numbers = catalogue["scara"], count()

    def record_more() -> None:
        learner = str(next(numbers))
        new = [new_attempt(scara, f"{learner}.{i}", TABLE.format("θ2")) for i in range(50)]
        recorded_all(store, new)

    with long_reader(sqlite_url, killable), store.engine.connect():
        while log_size(sqlite_url) <= 2 * LARGE_LOG:
            record_more()
    with store.engine.connect():
        # The first commit writes the log into the database, the second begins the log anew.
        for _ in range(3):
            record_more()
        assert log_size(sqlite_url) <= LARGE_LOG
    store.close()


def test_a_store_finishes_an_erasure_when_it_starts(
    sqlite_url: str, catalogue: Mapping[str, Exercise]
) -> None:
    store = AttemptStore.open(sqlite_url)
    recorded(store, catalogue["scara"], "ada-4711", TABLE.format(WRITTEN))
    # An open reader prevents SQLite from truncating the log when other connections close.
    with reader(sqlite_url):
        in_transaction(store.engine, lambda connection: forget(connection, "ada-4711"))
        store.close()
        assert files_with(WRITTEN, sqlite_url)
    idle = open_database(sqlite_url, create=False)
    with idle.connect() as connection:
        connection.exec_driver_sql("PRAGMA user_version")
        connection.rollback()
        again = AttemptStore.open(sqlite_url)
        again.start()
        until_erased(WRITTEN, sqlite_url)
        again.close()
    idle.dispose()


@pytest.mark.long
def test_no_data_is_left_of_learners_whose_rows_were_rewritten(
    sqlite_url: str, catalogue: Mapping[str, Exercise]
) -> None:
    # Regrade, override and delete rows of many sizes in random order.
    store = AttemptStore.open(sqlite_url)
    scara, draw = catalogue["scara"], random.Random(4)
    learners = [f"learner-{number:03}" for number in range(40)]
    for learner in learners:
        for ordinal in range(1, draw.randint(2, 4)):
            padding = f"{learner}x" * draw.randint(1, 120)
            submission = {"answers": {"table": padding}}
            attempt = recorded(
                store, scara, learner, TABLE.format("0"), ordinal,
                report=f'{{"read": "{padding}"}}', submission=str(submission),
            )  # fmt: skip
            if draw.random() < 0.3:
                with store.engine.execution_options(writes=True).begin() as connection:
                    override(connection, attempt.id, 1.0, f"{learner} asked", "me", NOON)
    regrading = Regrading(replace(scara, version="2"), FeedbackLevel.FULL)
    with store.engine.execution_options(writes=True).begin() as connection:
        regrading.enqueue(connection)
    draw.shuffle(learners)
    for learner in learners[:30]:
        assert forgotten(store.engine, learner) is True
        assert files_with(learner, sqlite_url) == []
    assert all(files_with(learner, sqlite_url) for learner in learners[30:])
    store.close()


def test_postgresql_overwrites_in_its_own_time(postgresql_url: str) -> None:
    store = AttemptStore.open(postgresql_url)
    LogCutter(store.engine).next()
    assert overwrite_deleted(store.engine) is None
    store.close()
