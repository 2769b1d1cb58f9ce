"""Test migrations."""

import asyncio
import csv
import json
import multiprocessing
import os
import random
import shutil
import signal
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime, timedelta
from functools import cache
from itertools import count
from pathlib import Path
from typing import Any
from uuid import uuid4

import pytest
from alembic import command
from alembic.config import Config
from dh_grader.access import Secret
from dh_grader.access.key_ring import add_key, fits, revoke_key, settle
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.store import AttemptFilter, GradesFormat, UnusableDatabaseError, database
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import DatabaseFile, open_database
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import graded_attempts, history, page, written
from dh_grader.store.tables import attempts, metadata
from sqlalchemy import Engine, create_engine, event, inspect, make_url, select, text

from tests.guards import ANSWER
from tests.store.databases import KINDS, new_database, new_file
from tests.store.recorded import RIGHT, recorded, regraded

# --- Today's program opens a database of the program's first version

OLDEST = "0001"
MIGRATIONS = Path(database.__file__).parent / "migrations"
# A report of an older exercise version, in which the right table earned nothing.
REPORT = json.dumps(
    {
        "exercise": "scara",
        "version": "0",
        "grader": "0.0.1",
        "feedback": "hints",
        "parts": [{"part": "table", "verdict": "incorrect", "points": 0.0, "rows": []}],
    }
)
OUTCOME = '{"table":{"verdict":"incorrect","cells":{},"codes":[]}}'
ROWS: tuple[dict[str, Any], ...] = (
    {"id": "a" * 32, "learner": "ada", "ordinal": 1, "is_late": True, "worth": 0.5, "key": "k"},
    {"id": "b" * 32, "learner": "bob", "ordinal": None, "is_late": False, "worth": 1, "key": None},
)
# The statement with which the first version records an attempt.
INSERT = (
    "INSERT INTO attempts (id, exercise, learner, ordinal, at, is_late, worth, submission, "
    "answers_digest, report, version, grader, points, max_points, outcome, owner, idempotency_key, "
    "request_digest) VALUES (:id, 'scara', :learner, :ordinal, '2026-09-01 12:00:00.000000{zone}', "
    ":is_late, :worth, :submission, 'x', :report, '0', '0.0.1', 0.0, 16.0, 1, 'course', :key, 'r')"
)
FIXED = {"submission": json.dumps({"answers": {"table": RIGHT}}), "report": REPORT}


def make_old(url: str, revision: str) -> None:
    parsed = make_url(url if "://" in url else f"sqlite:///{url}")
    zone = ""
    if parsed.get_backend_name() == "postgresql":
        parsed, zone = parsed.set(drivername="postgresql+psycopg"), "+00"
    engine = create_engine(parsed)
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    with engine.execution_options(writes=True).begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, revision)
        connection.execute(
            text(
                "INSERT INTO outcomes (exercise, digest, content) VALUES ('scara', 'd', :content)"
            ),
            {"content": OUTCOME},
        )
        connection.execute(text(INSERT.format(zone=zone)), [row | FIXED for row in ROWS])
    engine.dispose()


@pytest.fixture(params=["sqlite", "postgresql"])
def oldest(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    if request.param == "sqlite":
        url = f"sqlite:///{new_file(tmp_path)}"
    else:
        url = new_database(request.getfixturevalue("postgresql"), f"first_{uuid4().hex}")
    make_old(url, OLDEST)
    return url


@pytest.fixture
def store(oldest: str) -> Iterator[AttemptStore]:
    store = AttemptStore.open(oldest)
    store.start()
    yield store
    store.close()


def test_keys_without_a_recorded_secret_get_that_of_the_next_key(store: AttemptStore) -> None:
    right, other, now = Secret("right" * 8), Secret("other" * 8), datetime.now(UTC)
    with store.engine.execution_options(writes=True).begin() as connection:
        key = add_key(connection, "a", "d", (), None, now, now + timedelta(days=1))
        assert fits(connection, right)
        assert fits(connection, other)
        assert settle(connection, right, now)
        assert fits(connection, right)
        assert not fits(connection, other)
        assert not settle(connection, other, now)
        assert revoke_key(connection, key.id, now)
        assert settle(connection, other, now)
        assert not fits(connection, right)


def exported(store: AttemptStore) -> list[dict[str, str]]:
    with store.engine.connect() as connection:
        graded = graded_attempts(connection, AttemptFilter("scara"), lambda _: "best")
        lines = b"".join(written(graded, GradesFormat.CSV, "")).decode("utf-8-sig").splitlines()
    return list(csv.DictReader(lines))


def test_attempts_of_the_first_version_are_read_regraded_and_exported(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    scara = catalogue["scara"]
    table: Any = scara.part("table")
    with store.engine.connect() as connection:
        found, _ = page(connection, AttemptFilter("scara"), None, 10)
        untouched = history(connection, ROWS[0]["id"])
    assert [(each.learner, each.ordinal, each.is_late, each.points) for each in found] == [
        ("bob", None, False, 0.0),
        ("ada", 1, True, 0.0),
    ]
    assert {each.at.isoformat() for each in found} == {"2026-09-01T12:00:00+00:00"}
    assert untouched is not None
    assert (untouched.report, untouched.earlier) == (REPORT, [])
    # An old request is recognized by its idempotency key.
    earlier = asyncio.run(store.standing("scara", "ada", "course", "k")).earlier
    assert earlier is not None
    assert earlier.id == ROWS[0]["id"]

    regrading = Regrading(scara, FeedbackLevel.HINTS)
    done = regraded(store, regrading)
    assert [(each.learner, each.before, each.after) for each in done] == [
        ("ada", 0.0, table.points / 2),
        ("bob", 0.0, table.points),
    ]
    new = {f"{part.id} is new, missing" for part in scara.parts if part.id != "table"}
    assert {reason for each in done for reason in each.reasons} == {
        "table incorrect → correct",
        *new,
    }
    with store.engine.connect() as connection:
        after = history(connection, ROWS[0]["id"])
    assert after is not None
    assert [(each.report, each.version) for each in after.earlier] == [(REPORT, "0")]
    assert [
        (row["learner"], float(row["points"]), row["counts"], row["version"])
        for row in exported(store)
    ] == [
        ("ada", table.points / 2, "true", scara.version),
        ("bob", table.points, "false", scara.version),
    ]


# --- Migrations may be interrupted, and may run at the same time

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
