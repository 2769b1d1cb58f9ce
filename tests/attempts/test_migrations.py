"""Migrations may be interrupted, and may run at the same time."""

import multiprocessing
import os
import random
import shutil
import signal
import sqlite3
import threading
import time
from collections.abc import Callable, Mapping
from functools import cache
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.store import UnusableDatabaseError, database
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import DatabaseFile, open_database
from dh_grader.store.tables import attempts, metadata
from sqlalchemy import Engine, event, inspect, select, text

from tests.attempts.databases import KINDS, new_database, new_file
from tests.attempts.recorded import RIGHT, recorded
from tests.attempts.test_upgrade import FIXED, INSERT, REPORT, ROWS, make_old
from tests.guards import ANSWER

REVISIONS = ("0001", "0002", "0003", "0004")
# The statements before which a migration from the oldest revision is killed, of more than 25.
SOME = (2, 15, 25)
EVERY = range(1, 40)
_number = count()

OldDatabase = Callable[[str], str]


@pytest.fixture(params=KINDS)
def old(request: pytest.FixtureRequest, tmp_path: Path) -> OldDatabase:
    if request.param == "sqlite":

        @cache
        def file(revision: str) -> str:
            (folder := tmp_path / revision).mkdir()
            make_old(found := new_file(folder), revision)
            return found

        return lambda revision: str(shutil.copy(file(revision), tmp_path / f"{next(_number)}.db"))
    server = request.getfixturevalue("postgresql")

    @cache
    def template(revision: str) -> str:
        name = f"old{revision}_{next(_number)}"
        make_old(new_database(server, name), revision)
        return name

    return lambda revision: new_database(server, f"old{next(_number)}", template(revision))


def _open(url: str, killed_at: int, barrier: Any = None) -> None:
    steps = count(1)

    def step(*_: object) -> None:
        if next(steps) == killed_at:
            os.kill(os.getpid(), signal.SIGKILL)

    event.listen(Engine, "before_cursor_execute", step)
    event.listen(Engine, "commit", step)
    if barrier is not None:
        barrier.wait(ANSWER)
    open_database(url).dispose()


def check_whole(url: str) -> None:
    engine = open_database(url)
    with engine.connect() as connection:
        found = inspect(connection)
        columns = {
            name: {each["name"] for each in found.get_columns(name)}
            for name in found.get_table_names()
            if name != "alembic_version"
        }
        kept = connection.execute(
            select(attempts.c.id, attempts.c.learner, attempts.c.report).order_by(attempts.c.id)
        ).all()
    engine.dispose()
    assert columns == {
        name: {column.name for column in table.columns} for name, table in metadata.tables.items()
    }
    assert kept == [(row["id"], row["learner"], REPORT) for row in ROWS]


def kill_before(url: str, statement: int, killable: Any) -> bool:
    process = killable(target=_open, args=(url, statement))
    process.start()
    process.join(ANSWER)
    assert process.exitcode in (0, -signal.SIGKILL)
    return bool(process.exitcode)


@pytest.mark.long
def test_a_killed_migration_is_finished_by_the_next_start(old: OldDatabase, killable: Any) -> None:
    killed = []
    for statement in SOME:
        url = old("0001")
        killed.append(kill_before(url, statement, killable))
        check_whole(url)
    assert killed == [True] * len(SOME)


@pytest.mark.campaign
@pytest.mark.parametrize("revision", REVISIONS)
def test_a_migration_killed_before_any_statement_is_finished_later(
    old: OldDatabase, killable: Any, revision: str
) -> None:
    for statement in EVERY:
        url = old(revision)
        if not kill_before(url, statement, killable):
            break
        check_whole(url)
    assert statement > 5


@pytest.mark.campaign
@pytest.mark.parametrize("revision", REVISIONS)
def test_a_migration_killed_at_any_moment_is_finished_later(
    old: OldDatabase, killable: Any, revision: str
) -> None:
    dice = random.Random(revision)
    ends = set()
    for _ in range(20):
        url = old(revision)
        process = killable(target=_open, args=(url, 0))
        process.start()
        time.sleep(dice.uniform(0.0, 0.3))
        process.kill()
        process.join(ANSWER)
        ends.add(process.exitcode)
        check_whole(url)
    assert -signal.SIGKILL in ends


@pytest.mark.long
def test_several_processes_migrate_at_once(old: OldDatabase, killable: Any) -> None:
    barrier = multiprocessing.get_context("forkserver").Barrier(3)
    url = old("0001")
    processes = [killable(target=_open, args=(url, 0, barrier)) for _ in range(3)]
    for process in processes:
        process.start()
    for process in processes:
        process.join(ANSWER)
    assert [process.exitcode for process in processes] == [0, 0, 0]
    check_whole(url)


def test_a_start_waits_for_another_process_that_migrates_sqlite(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "attempts.db"
    make_old(str(path), "0010")
    monkeypatch.setattr(database, "_LOCK_WAIT", 0.05)
    other = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
    other.execute("PRAGMA journal_mode = WAL")
    other.execute("BEGIN IMMEDIATE")
    ending = threading.Timer(0.5, lambda: other.execute("COMMIT"))
    ending.start()
    open_database(str(path)).dispose()
    ending.join()
    other.close()


def test_a_start_waits_for_another_process_that_opens_the_same_new_file(tmp_path: Path) -> None:
    path = tmp_path / "attempts.db"
    other = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
    other.execute("BEGIN IMMEDIATE")
    # SQLite itself shall not wait: where it does depends on the moment.
    mine = sqlite3.connect(path, isolation_level=None, timeout=0.0)
    with pytest.raises(sqlite3.OperationalError, match="locked"):
        mine.execute("PRAGMA journal_mode = WAL")
    ending = threading.Timer(0.3, lambda: other.execute("COMMIT"))
    ending.start()
    DatabaseFile(database._engine(str(path)), ANSWER)._set_up(mine, None)
    ending.join()
    other.close()
    assert mine.execute("PRAGMA journal_mode").fetchone() == ("wal",)
    mine.close()


def test_an_older_program_goes_on_recording_while_a_newer_one_migrates(
    old: OldDatabase, catalogue: Mapping[str, Exercise]
) -> None:
    url = old("0001")
    told: list[str] = []
    failures: list[Exception] = []
    over = threading.Event()
    # This engine does not migrate; its INSERT is that of the first version.
    engine = _bare(url)
    insert = INSERT.format(zone="" if engine.dialect.name == "sqlite" else "+00")

    def record() -> None:
        for number in count():
            row = ROWS[1] | FIXED | {"id": f"{number:032}", "learner": "carl", "key": f"c{number}"}
            try:
                with engine.connect() as connection:
                    connection = connection.execution_options(writes=True)
                    with connection.begin():
                        connection.execute(text(insert), row)
            except Exception as error:  # noqa: BLE001 - the test reports any error
                failures.append(error)
                return
            told.append(row["id"])
            # SQLite's lock is not fair: leave some time for the other process.
            if over.wait(0.01):
                return

    thread = threading.Thread(target=record)
    thread.start()
    while not told and not failures:
        time.sleep(0.01)
    store = AttemptStore.open(url)
    recorded(store, catalogue["scara"], "dora", RIGHT)
    known = len(told)
    while len(told) == known and not failures:
        time.sleep(0.01)
    over.set()
    thread.join(ANSWER)
    engine.dispose()
    assert failures == []
    with store.engine.connect() as connection:
        found = set(connection.scalars(select(attempts.c.id).where(attempts.c.learner == "carl")))
        assert connection.scalar(select(attempts.c.ordinal).where(attempts.c.learner == "dora"))
    store.close()
    assert found == set(told)


def _bare(url: str) -> Engine:
    engine: Engine = database._engine(url)
    return engine


def test_a_newer_version_s_database_is_refused_and_stays_as_it_is(old: OldDatabase) -> None:
    url = old("0003")
    check_whole(url)
    newer = _bare(url)
    with newer.begin() as connection:
        connection.execute(text("ALTER TABLE attempts ADD COLUMN newer INTEGER"))
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    for opening in (open_database, AttemptStore.open):
        with pytest.raises(UnusableDatabaseError, match="those of a newer version of the program"):
            opening(url)
    with newer.connect() as connection:
        names = {each["name"] for each in inspect(connection).get_columns("attempts")}
        assert "newer" in names
        assert connection.scalars(text("SELECT version_num FROM alembic_version")).all() == ["9999"]
        assert len(connection.execute(text("SELECT * FROM attempts")).all()) == len(ROWS)
    newer.dispose()
