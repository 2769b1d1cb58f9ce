"""On a full or read-only disk, the service says that it cannot record, and loses nothing."""

import errno
import os
import shutil
import sqlite3
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import closing
from pathlib import Path
from typing import Final

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.cli import program
from dh_grader.store import UnusableDatabaseError
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import open_database
from sqlalchemy import event
from typer.testing import CliRunner, Result

from tests.api.conftest import InProcess
from tests.store.databases import new_file
from tests.store.recorded import NO_TWIST, RIGHT, new_attempt, recorded_all
from tests.store.test_backup import ids

ATTEMPTS: Final = "/v1/exercises/scara/attempts"


def _mounted(folder: Path, *options: str) -> bool:
    # Only root may mount file systems.
    try:
        done = subprocess.run(["mount", *options, str(folder)], capture_output=True, check=False)
    except OSError:
        return False
    return done.returncode == 0


class SmallDisk:
    """A folder on a file system of its own, or, without root, a limit of SQLite."""

    def __init__(self, folder: Path, *, is_real: bool) -> None:
        self.folder, self.is_real = folder, is_real
        self._filler = folder / "filler"
        self._most: int | None = None

    def open(self) -> AttemptStore:
        store = AttemptStore.open(new_file(self.folder))
        store.start()
        event.listen(store.engine, "checkout", self._limit)
        return store

    def _limit(self, connection: sqlite3.Connection, *_: object) -> None:
        if not self.is_real:
            connection.execute(f"PRAGMA max_page_count = {self._most or 2**30}")

    def fill(self) -> None:
        if not self.is_real:
            with closing(sqlite3.connect(new_file(self.folder))) as connection:
                [self._most] = connection.execute("PRAGMA page_count").fetchone()
            return
        size = 64 * 1024
        with self._filler.open("ab", buffering=0) as file:
            while size:
                try:
                    file.write(b"x" * size)
                except OSError as error:
                    if error.errno != errno.ENOSPC:
                        raise
                    size //= 2

    def free(self) -> None:
        self._most = None
        self._filler.unlink(missing_ok=True)


@pytest.fixture(params=[True, False])
def disk(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[SmallDisk]:
    # Without root, both cases limit the size of the database.
    is_real = request.param and _mounted(tmp_path, "-t", "tmpfs", "-o", "size=4m", "tmpfs")
    yield SmallDisk(tmp_path, is_real=is_real)
    if is_real:
        subprocess.run(["umount", "--lazy", str(tmp_path)], check=True)


def test_a_service_on_a_full_disk_is_not_ready_until_there_is_room(
    disk: SmallDisk, catalogue: Mapping[str, Exercise]
) -> None:
    store = disk.open()
    app = application(catalogue, store=store)
    told: dict[str, str] = {}
    with httpx.Client(transport=InProcess(app), base_url="http://service") as client:

        def post(key: str) -> int:
            body = {"learner": "ada", "answers": {"table": NO_TWIST}}
            answer = client.post(ATTEMPTS, json=body, headers={"Idempotency-Key": key})
            if answer.status_code == 201:
                told[key] = answer.json()["attempt"]["id"]
            return answer.status_code

        assert post("0") == 201
        assert client.get("/readyz").status_code == 200
        for turn in range(3):
            disk.fill()
            key = f"{turn}.0"
            while post(key) == 201:
                key = f"{turn}.{len(told)}"
            # The success of a second ago does not count any more.
            answers = [client.get("/readyz") for _ in range(3)]
            assert [answer.status_code for answer in answers] == [503] * 3
            assert answers[0].json()["type"].endswith(":store-down")
            assert client.get("/healthz").status_code == 200
            graded = client.post("/v1/exercises/scara/grade", json={"answers": {"table": RIGHT}})
            assert graded.status_code == 200
            disk.free()
            assert client.get("/readyz").status_code == 200
            assert post(key) == 201
    store.close()
    assert ids(new_file(disk.folder)) == set(told.values())


@pytest.fixture
def read_only(tmp_path: Path, catalogue: Mapping[str, Exercise]) -> Iterator[Path]:
    """A database with one attempt, on a disk that cannot be written."""
    folder = Path(tempfile.mkdtemp(dir="/tmp"))
    is_real = _mounted(folder, "-t", "tmpfs", "-o", "size=4m", "tmpfs")
    file = Path(new_file(folder))
    store = AttemptStore.open(str(file))
    recorded_all(store, [new_attempt(catalogue["scara"], "ada", RIGHT)])
    store.close()
    if is_real:
        subprocess.run(["mount", "-o", "remount,ro", str(folder)], check=True)
    else:
        file.chmod(0o444)
        folder.chmod(0o555)
    yield file
    if is_real:
        subprocess.run(["mount", "-o", "remount,rw", str(folder)], check=True)
    folder.chmod(0o755)
    assert len(ids(str(file))) == 1
    if is_real:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)
    shutil.rmtree(folder)


@pytest.mark.skipif(os.name != "posix", reason="there are no such permissions")
def test_nothing_starts_or_changes_on_a_read_only_disk(
    read_only: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def run(*words: object) -> Result:
        return CliRunner().invoke(program, list(map(str, words)))

    monkeypatch.setenv("DH_GRADER_DATABASE", str(read_only))
    with pytest.raises(UnusableDatabaseError, match=r"readonly database|unable to open"):
        AttemptStore.open(str(read_only))
    elsewhere = str(tmp_path / "elsewhere.db")
    open_database(elsewhere).dispose()
    for words in (
        ("attempts", "forget", "ada", "--yes"),
        ("attempts", "migrate"),
        ("restore", elsewhere, "--replace"),
        ("backup", str(read_only.with_name("copy.db"))),
    ):
        told = run(*words)
        assert told.exit_code == 2, words
        assert not isinstance(told.exception, sqlite3.Error), words
    # A backup to another disk has everything, if this is really a disk that nobody can write.
    if os.statvfs(read_only).f_flag & os.ST_RDONLY:
        copy = tmp_path / "copy.db"
        done = run("backup", copy)
        assert done.exit_code == 0, done.output
        assert len(ids(str(copy))) == 1
