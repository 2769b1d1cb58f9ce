"""The service reports a locked, full or missing database, and recovers afterwards."""

import asyncio
import shutil
import sqlite3
import time
from collections.abc import Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.store import AttemptFilter, StoreDownError
from dh_grader.store.attempt_store import AttemptStore
from sqlalchemy import event

from tests.attempts.recorded import RIGHT, new_attempt, record_once
from tests.guards import ANSWER


def record(store: AttemptStore, exercise: Exercise, ordinal: int) -> bool:
    new, outcome = new_attempt(exercise, "ada", RIGHT, ordinal)
    return asyncio.run(record_once(store, new, outcome)) is not None


def test_a_locked_file_is_reported_after_a_wait_and_works_once_unlocked(
    sqlite_url: str, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("dh_grader.store.database._LOCK_WAIT", 0.5)
    scara = catalogue["scara"]
    store = AttemptStore.open(sqlite_url)
    store.start()
    other = sqlite3.connect(sqlite_url, isolation_level=None)
    other.execute("BEGIN EXCLUSIVE")
    begun = time.monotonic()
    with pytest.raises(StoreDownError, match="locked"):
        record(store, scara, 1)
    assert 0.4 < time.monotonic() - begun < ANSWER
    other.execute("ROLLBACK")
    other.close()
    assert record(store, scara, 1)
    store.close()


@pytest.mark.parametrize("replaced", [False, True])
def test_a_deleted_or_replaced_file_takes_no_attempts(
    sqlite_url: str, catalogue: Mapping[str, Exercise], replaced: bool
) -> None:
    store = AttemptStore.open(sqlite_url)
    store.start()
    assert record(store, catalogue["scara"], 1)
    file = Path(sqlite_url)
    aside = file.rename(file.with_name("aside.db"))
    if replaced:
        shutil.copy(aside, file)
    for attempt in range(2, 4):
        with pytest.raises(StoreDownError, match="deleted or replaced"):
            record(store, catalogue["scara"], attempt)
    for asked in (store.check(), store.page(AttemptFilter(), None, 1)):
        with pytest.raises(StoreDownError, match="deleted or replaced"):
            asyncio.run(asked)
    assert file.exists() == replaced
    aside.rename(file)
    assert record(store, catalogue["scara"], 2)
    store.close()


def test_a_full_disk_is_reported_and_loses_no_recorded_attempt(
    sqlite_url: str, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    store = AttemptStore.open(sqlite_url)
    pages = 60
    event.listen(
        store.engine,
        "connect",
        lambda connection, _: connection.execute(f"PRAGMA max_page_count = {pages}"),
    )
    store.start()
    acknowledged = list[int]()

    def until_it_is_full() -> None:
        for ordinal in range(1, 200):
            record(store, scara, ordinal)
            acknowledged.append(ordinal)

    with pytest.raises(StoreDownError, match="full"):
        until_it_is_full()
    found = asyncio.run(store.standing("scara", "ada", "", None))
    assert found.counted == len(acknowledged) > 0
    store.close()
