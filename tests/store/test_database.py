"""Test the writer of a database, its faults, and databases that are read only."""

import asyncio
import os
import re
import shutil
import sqlite3
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.store import AttemptFilter, StoreDownError, UnusableDatabaseError
from dh_grader.store import database as module
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import AttemptWriter, open_database
from sqlalchemy import Connection, Engine, event

from tests.api.conftest import InProcess
from tests.guards import ANSWER
from tests.store.databases import KINDS
from tests.store.recorded import NO_TWIST, RIGHT, new_attempt, record_once

# --- Test how the writer thread groups its work into transactions


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


# --- The service reports a locked, full or missing database, and recovers afterwards


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


# --- Test databases that can be read but not written

STRANGER = 65534


@pytest.fixture(params=KINDS)
def store_and_switch(
    request: pytest.FixtureRequest,
) -> Iterator[tuple[AttemptStore, Callable[[str], None]]]:
    url = request.getfixturevalue(f"{request.param}_url")
    store = AttemptStore.open(url)
    store.start()
    if request.param == "sqlite":
        state = {"now": "off"}
        event.listen(
            store.engine,
            "connect",
            lambda connection, _: connection.execute(f"PRAGMA query_only = {state['now']}"),
        )

        def switch(to: str) -> None:
            state["now"] = to
            store.engine.dispose()
    else:
        server, name = request.getfixturevalue("postgresql"), store.engine.url.database

        def switch(to: str) -> None:
            server.psql(f"""
                SET default_transaction_read_only = off;
                ALTER DATABASE {name} SET default_transaction_read_only = {to};
                SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = '{name}';
            """)
            # Drop the connections that the server has closed.
            store.engine.dispose()

    yield store, switch
    store.close()


def test_a_read_only_database_stops_only_recording(
    store_and_switch: tuple[AttemptStore, Callable[[str], None]],
    catalogue: Mapping[str, Exercise],
    caplog: pytest.LogCaptureFixture,
) -> None:
    store, switch = store_and_switch
    app = application(catalogue, store=store, access=Access(read_attempts=True))
    with httpx.Client(transport=InProcess(app), base_url="http://service") as client:

        def post(key: str) -> httpx.Response:
            body = {"learner": "ada", "answers": {"table": NO_TWIST}}
            address = "/v1/exercises/scara/attempts"
            return client.post(address, json=body, headers={"Idempotency-Key": key})

        first = post("first")
        assert first.status_code == 201
        switch("on")
        refused = post("second")
        assert (refused.status_code, refused.headers["retry-after"]) == (503, "5")
        assert refused.json()["type"].endswith(":store-down")
        assert "read-only" in caplog.text.replace("readonly", "read-only")
        assert client.get("/readyz").status_code == 503
        graded = client.post("/v1/exercises/scara/grade", json={"answers": {"table": NO_TWIST}})
        assert graded.json() == first.json()["report"]
        assert len(client.get("/v1/attempts").json()["attempts"]) == 1
        with pytest.raises(UnusableDatabaseError, match=r"cannot be recorded there: .*read-?only"):
            AttemptStore.open(_read_only(store))
        switch("off")
        assert post("second").status_code == 201
        assert client.get("/readyz").status_code == 200


def _read_only(store: AttemptStore) -> str:
    url = store.engine.url
    if url.get_backend_name() == "sqlite":
        return f"sqlite:///file:{url.database}?mode=ro&uri=true"
    return url.render_as_string(hide_password=False)


@contextmanager
def without_permission(path: Path) -> Iterator[None]:
    path.chmod(0o555)
    is_root = os.geteuid() == 0
    if is_root:
        os.seteuid(STRANGER)
    try:
        yield
    finally:
        if is_root:
            os.seteuid(0)
        path.chmod(0o755)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such permissions")
@pytest.mark.parametrize("whole_folder", [True, False])
def test_a_file_without_write_permission_is_reported_at_startup(whole_folder: bool) -> None:
    # Other users can read this folder, unlike the folders of pytest.
    folder = Path(tempfile.mkdtemp(dir="/tmp"))
    try:
        file = folder / "attempts.db"
        open_database(str(file)).dispose()
        file.chmod(0o666)
        folder.chmod(0o777)
        before = file.read_bytes()
        place = folder if whole_folder else file
        with without_permission(place), pytest.raises(UnusableDatabaseError) as told:
            AttemptStore.open(str(file))
        assert str(file) in str(told.value)
        assert re.search("readonly database|unable to open database file", str(told.value))
        assert file.read_bytes() == before
    finally:
        shutil.rmtree(folder)
