"""Deleted data is in no file of an SQLite database any more."""

import random
import time
from collections.abc import Mapping
from dataclasses import replace

import pytest
from sqlalchemy import Engine

from service.attempts.regrades.outdated import Regrading
from service.attempts.storage.database import in_transaction, open_database
from service.attempts.storage.erasure import finish_overwriting, overwrite_deleted
from service.attempts.store import AttemptStore
from service.attempts.tutoring import forget, override
from service.catalogue import Exercise, FeedbackLevel
from tests.attempts.erasure import files_with, reader
from tests.attempts.recorded import NOON, recorded
from tests.guards import ANSWER

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
        finish_overwriting(store.engine)
        assert files_with(WRITTEN, sqlite_url)
        # Writers do not wait for the reader.
        recorded(store, catalogue["scara"], "grace", TABLE.format("θ2"))
    finish_overwriting(store.engine)
    assert files_with(WRITTEN, sqlite_url) == files_with("ada-4711", sqlite_url) == []
    assert files_with("grace", sqlite_url)
    store.close()


@pytest.mark.long
def test_a_running_store_finishes_the_erasure_of_another_program(
    sqlite_url: str, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.attempts.storage.writer._TIDY_INTERVAL", 0.05)
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
    finish_overwriting(store.engine)
    assert overwrite_deleted(store.engine) is None
    store.close()
