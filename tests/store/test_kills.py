"""Kill commands and the service at many moments: a database is old or new, never between."""

import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import closing
from itertools import count
from pathlib import Path
from typing import Any, Final

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.store import database
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.attempts import record
from dh_grader.store.database import before, in_transaction, open_database, unfinished
from dh_grader.store.results import override
from dh_grader.store.tables import attempts, earlier_reports, overrides
from sqlalchemy import func, select, text

from tests.guards import ANSWER
from tests.store.databases import KINDS, new_database
from tests.store.killed_commands import Ended, command, kills, moments
from tests.store.recorded import NOON, RIGHT, files_with, new_attempt
from tests.store.test_backup import PROGRAMS, ids, recording
from tests.store.test_backup import command as documented
from tests.store.test_migrations import check_whole, make_old

KILLS: Final = 20
# The attempts of Ada; Grace has as many.
MANY: Final = 150
SAMPLE_AND_CAMPAIGN: Final = [
    pytest.param(2, marks=pytest.mark.long),
    pytest.param(KILLS, marks=[pytest.mark.campaign, pytest.mark.timeout(3600)]),
]
_number = count()

Figure = Callable[[str], None]


def fill(url: str, exercise: Exercise, learners: tuple[str, ...] = ("ada", "grace")) -> set[str]:
    """Record attempts that an earlier version of the exercise graded; return their ids."""
    engine = open_database(url)

    def work(connection: Any) -> None:
        for learner in learners:
            for ordinal in range(1, MANY + 1):
                new, outcome = new_attempt(exercise, learner, RIGHT, ordinal, version="0")
                written = record(connection, new, outcome)
                assert written
                if ordinal % 10 == 0:
                    override(connection, written.id, 1.0, "a reason", "me", NOON)

    in_transaction(engine, work)
    engine.dispose()
    return ids(url)


class Databases:
    """Makes copies of databases: files of SQLite, or databases on a PostgreSQL server."""

    def __init__(self, kind: str, folder: Path, server: Any) -> None:
        self.kind, self._folder, self.server = kind, folder, server

    def new(self) -> str:
        name = f"killed{next(_number)}"
        if self.kind == "sqlite":
            (self._folder / name).mkdir()
            return str(self._folder / name / "attempts.db")
        return new_database(self.server, name)

    def like(self, url: str) -> str:
        name = f"killed{next(_number)}"
        if self.kind == "postgresql":
            template = database.unmigrated_database(url).url.database
            assert template
            return new_database(self.server, name, template)
        (self._folder / name).mkdir()
        copy = self._folder / name / "attempts.db"
        with closing(sqlite3.connect(url)) as connection:
            connection.execute("VACUUM INTO ?", (str(copy),))
        return str(copy)


@pytest.fixture(params=KINDS)
def databases(request: pytest.FixtureRequest, tmp_path: Path) -> Databases:
    needs_server = request.param == "postgresql"
    server = request.getfixturevalue("postgresql") if needs_server else None
    return Databases(request.param, tmp_path, server)


@pytest.fixture
def sqlite(tmp_path: Path) -> Databases:
    return Databases("sqlite", tmp_path, None)


def check_sound(url: str) -> None:
    """Assert that an SQLite file is sound."""
    if "://" in url:
        return
    with closing(sqlite3.connect(url)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert connection.execute("PRAGMA foreign_key_check").fetchall() == []


def test_a_restore_killed_before_any_step_leaves_the_old_or_the_new_database(
    sqlite: Databases, catalogue: Mapping[str, Exercise], killable: Any
) -> None:
    check_restore_steps(sqlite, catalogue["scara"], killable, range(1, 4))


@pytest.mark.long
def test_a_restore_killed_before_every_step_leaves_the_old_or_the_new_database(
    sqlite: Databases, catalogue: Mapping[str, Exercise], killable: Any
) -> None:
    check_restore_steps(sqlite, catalogue["scara"], killable, range(1, 80))


def check_restore_steps(sqlite: Databases, exercise: Exercise, killable: Any, steps: range) -> None:
    first, second = sqlite.new(), sqlite.new()
    old, new = fill(first, exercise, ("ada",)), fill(second, exercise, ("grace",))
    found = []
    for step in steps:
        url = sqlite.like(first)
        # The old database has a log that its service could not write into it.
        in_log = killed_with_a_log(url, exercise, killable)
        code = command(killable, url, "restore", second, "--replace", before_step=step).code
        found.append(check_restored(killable, url, second, old | in_log, new))
        if code == 0:
            break
        assert code == -signal.SIGKILL
    else:
        assert steps.stop < 80
        return
    assert found[0] == "old"
    assert found[-1] == "new"


def _record_and_die(url: str, exercise: Exercise) -> None:
    engine = open_database(url)
    new, outcome = new_attempt(exercise, "carl", RIGHT, 1)
    in_transaction(engine, lambda connection: record(connection, new, outcome))
    os.kill(os.getpid(), signal.SIGKILL)


def killed_with_a_log(url: str, exercise: Exercise, killable: Any) -> set[str]:
    process = killable(target=_record_and_die, args=(url, exercise))
    process.start()
    process.join(ANSWER)
    assert Path(f"{url}-wal").stat().st_size
    with closing(sqlite3.connect(f"file:{url}?mode=ro", uri=True)) as connection:
        found = connection.execute("SELECT id FROM attempts WHERE learner = 'carl'").fetchall()
    assert len(found) == 1
    return {found[0][0]}


def check_restored(killable: Any, url: str, backup: str, old: set[str], new: set[str]) -> str:
    """Assert that a killed restore left the old or the new database, and finish it."""
    # A service starts on what is there, and never creates an empty database.
    assert Path(url).is_file()
    AttemptStore.open(url).close()
    found = ids(url)
    assert found in (old, new)
    check_sound(url)
    kept = before(Path(url))
    if kept.exists():
        assert kept.samefile(url) or (found == new and ids(str(kept)) == old)
    state = "old" if found == old else "new"
    if state == "new":
        kept.rename(kept.with_name("aside.db"))
    assert command(killable, url, "restore", backup, "--replace").code == 0
    assert ids(url) == new
    assert ids(str(kept)) == found
    assert unfinished(Path(url)) == []
    return state


@pytest.mark.parametrize("times", SAMPLE_AND_CAMPAIGN)
def test_a_killed_restore_leaves_the_old_or_the_new_database(
    databases: Databases,
    catalogue: Mapping[str, Exercise],
    killable: Any,
    times: int,
    tmp_path: Path,
    figure: Figure,
) -> None:
    exercise, states = catalogue["scara"], Counter[str]()
    first, second = databases.new(), databases.new()
    old, new = fill(first, exercise, ("ada",)), fill(second, exercise, ("grace",))
    if databases.kind == "postgresql":
        restoring = Restoring(databases, first, second, tmp_path)
        seconds = restoring.run(None)
        for moment in moments(times, seconds, "restore"):
            restoring.reset()
            restoring.run(moment)
            found = ids(restoring.url)
            assert found in (old, new)
            states["old" if found == old else "new"] += 1
            if found == old:
                restoring.run(None)
                assert ids(restoring.url) == new
    else:
        url = databases.like(first)
        whole = command(killable, url, "restore", second, "--replace")
        assert whole.code == 0
        for kill in kills(times, whole, "restore"):
            url = databases.like(first)
            command(killable, url, "restore", second, "--replace", **kill)
            states[check_restored(killable, url, second, old, new)] += 1
    figure(f"{times} kills of restores on {databases.kind}: {dict(states)}")


def run_killed(line: str, folder: Path, moment: float | None, **environment: str) -> float:
    """Run a line of the shell; kill it and its programs after some seconds. Return its seconds."""
    paths = (str(PROGRAMS), str(Path(sys.executable).parent), os.environ["PATH"])
    settings = os.environ | environment | {"PATH": os.pathsep.join(paths)}
    begun = time.monotonic()
    process = subprocess.Popen(
        ["sh", "-e", "-c", line], cwd=folder, env=settings, start_new_session=True,
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        process.wait(ANSWER if moment is None else moment)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
    said = process.communicate()[1]
    assert process.returncode in (0, -signal.SIGKILL), said
    assert moment is not None or process.returncode == 0, said
    return time.monotonic() - begun


class Restoring:
    """Restores by the commands of docs/operations.md, in which the database is ``attempts``."""

    def __init__(self, databases: Databases, first: str, second: str, folder: Path) -> None:
        self._server, self._folder = databases.server, folder
        self._first = database.unmigrated_database(first).url
        self.url = first.replace(f"/{self._first.database}?", "/attempts?")
        dump = documented("pg_dump")
        run_killed(dump, folder, None, DH_GRADER_DATABASE=second)
        lines = [documented(words) for words in ("dropdb", "createdb", "pg_restore", "RENAME TO")]
        line = "\n".join(lines)
        # The URL of a socket has its folder after the name of the database.
        self._line = line.replace('"$SERVER/', '"').replace('"$SERVER"', "postgres")
        self.reset()

    def _sql(self, *statements: str) -> None:
        for statement in statements:
            self._server.psql(statement)

    def reset(self) -> None:
        self._sql(
            "DROP DATABASE IF EXISTS attempts WITH (FORCE)",
            "DROP DATABASE IF EXISTS attempts_before WITH (FORCE)",
            f"CREATE DATABASE attempts TEMPLATE {self._first.database}",
        )

    def run(self, moment: float | None) -> float:
        address = {"PGHOST": str(self._first.query["host"]), "PGUSER": str(self._first.username)}
        seconds = run_killed(self._line, self._folder, moment, **address)
        self._settle()
        return seconds

    def _settle(self) -> None:
        # The server goes on for a moment with what a killed program has told it to do.
        engine = database.unmigrated_database(self.url.replace("/attempts?", "/postgres?"))
        busy = text(
            "SELECT count(*) FROM pg_stat_activity WHERE application_name IN "
            "('createdb', 'dropdb', 'pg_restore', 'psql')"
        )
        with engine.execution_options(isolation_level="AUTOCOMMIT").connect() as connection:
            while connection.scalar(busy):
                time.sleep(0.01)
        engine.dispose()


@pytest.mark.parametrize("times", SAMPLE_AND_CAMPAIGN)
def test_a_killed_backup_leaves_no_half_file(
    databases: Databases,
    catalogue: Mapping[str, Exercise],
    killable: Any,
    times: int,
    tmp_path: Path,
    figure: Figure,
) -> None:
    url, exercise, states = databases.new(), catalogue["scara"], Counter[str]()
    fill(url, exercise)
    with recording(url, exercise) as told:

        def back_up(**moment: Any) -> tuple[Ended, Path, set[str]]:
            known = set(told)
            if databases.kind == "postgresql":
                copy = tmp_path / "attempts.dump"
                copy.unlink(missing_ok=True)
                line, after = documented("pg_dump"), moment.get("after")
                seconds = run_killed(line, tmp_path, after, DH_GRADER_DATABASE=url)
                return Ended(0, seconds, 0), copy, known
            copy = Path(url).with_name("copy.db")
            copy.unlink(missing_ok=True)
            ended = command(killable, url, "backup", copy, **moment)
            assert ended.code == 0 or moment
            return ended, copy, known

        whole = back_up()[0]
        with_steps = databases.kind == "sqlite"
        clock = ({"after": each} for each in moments(times, whole.seconds, "backup"))
        for moment in kills(times, whole, "backup") if with_steps else clock:
            _, copy, known = back_up(**moment)
            states["whole" if copy.exists() else "none"] += 1
            if copy.exists():
                assert known <= content(databases, copy, tmp_path)
        # The next backup succeeds, and leaves nothing of the killed ones.
        _, copy, known = back_up()
        assert known <= content(databases, copy, tmp_path)
        assert unfinished(copy) == []
    assert told <= ids(url)
    figure(f"{times} kills of backups on {databases.kind}: {dict(states)}")


def content(databases: Databases, copy: Path, folder: Path) -> set[str]:
    if databases.kind == "sqlite":
        check_sound(str(copy))
        return ids(str(copy))
    url = databases.new()
    address = database.unmigrated_database(url).url
    run_killed(
        f"pg_restore --no-owner --exit-on-error --dbname={address.database} {copy}", folder, None,
        PGHOST=str(address.query["host"]), PGUSER=str(address.username),
    )  # fmt: skip
    return ids(url)


@pytest.mark.parametrize("times", SAMPLE_AND_CAMPAIGN)
def test_a_killed_regrade_keeps_each_attempt_and_the_next_one_finishes_it(
    databases: Databases,
    catalogue: Mapping[str, Exercise],
    killable: Any,
    times: int,
    figure: Figure,
) -> None:
    exercise, done = catalogue["scara"], list[int]()
    first = databases.new()
    known = fill(first, exercise)
    words = ("attempts", "regrade", "scara", "--apply")
    whole = command(killable, databases.like(first), *words)
    assert whole.code == 0
    for moment in kills(times, whole, "regrade"):
        url = databases.like(first)
        command(killable, url, *words, **moment)
        done.append(check_regraded(url, known, exercise))
        assert command(killable, url, *words).code == 0
        assert check_regraded(url, known, exercise) == len(known)
    between = sum(0 < each < len(known) for each in done)
    figure(f"{times} kills of regrades on {databases.kind}: {between} in the middle")


def check_regraded(url: str, known: set[str], exercise: Exercise) -> int:
    """Assert that each attempt has its report before the regrade, or both; return the number."""
    check_sound(url)
    assert ids(url) == known
    engine = open_database(url)
    with engine.connect() as connection:
        earlier = (
            select(func.count())
            .where(earlier_reports.c.attempt == attempts.c.number)
            .correlate(attempts)
            .scalar_subquery()
        )
        rows = connection.execute(select(attempts.c.version, earlier)).all()
        assert connection.scalar(select(func.count()).select_from(overrides)) == 2 * (MANY // 10)
    engine.dispose()
    found = Counter(tuple(row) for row in rows)
    assert set(found) <= {("0", 0), (exercise.version, 1)}
    return found[(exercise.version, 1)]


@pytest.mark.parametrize("times", SAMPLE_AND_CAMPAIGN)
def test_a_killed_forget_deletes_everything_of_a_learner_or_nothing(
    databases: Databases,
    catalogue: Mapping[str, Exercise],
    killable: Any,
    times: int,
    figure: Figure,
) -> None:
    exercise, states = catalogue["scara"], Counter[int]()
    first = databases.new()
    fill(first, exercise)
    words = ("attempts", "forget", "ada", "--yes")
    whole = command(killable, databases.like(first), *words)
    assert whole.code == 0
    for moment in kills(times, whole, "forget"):
        url = databases.like(first)
        command(killable, url, *words, **moment)
        states[check_forgotten(url)] += 1
        # Also if there was nothing left to delete, no trace may remain on the disk.
        assert command(killable, url, *words).code in (0, 2)
        assert check_forgotten(url) == 0
        if databases.kind == "sqlite":
            assert files_with('"ada"', url) == []
    figure(f"{times} kills of forget on {databases.kind}: {dict(states)} attempts are left")


def check_forgotten(url: str) -> int:
    """Assert that all rows of Ada are there, or none; return how many attempts."""
    check_sound(url)
    engine = open_database(url)
    with engine.connect() as connection:
        rows = select(attempts.c.learner, func.count()).group_by(attempts.c.learner)
        found: dict[str, int] = {row.learner: row[1] for row in connection.execute(rows)}
        given = connection.scalar(select(func.count()).select_from(overrides))
    engine.dispose()
    assert found.pop("grace") == MANY
    left = found.pop("ada", 0)
    assert (left, given) in ((MANY, 2 * (MANY // 10)), (0, MANY // 10))
    assert found == {}
    return left


@pytest.mark.parametrize("times", SAMPLE_AND_CAMPAIGN)
def test_a_killed_migrate_leaves_the_old_or_the_new_tables(
    databases: Databases, killable: Any, times: int, figure: Figure
) -> None:
    first, states = databases.new(), Counter[str]()
    make_old(first, "0001")
    whole = command(killable, databases.like(first), "attempts", "migrate")
    assert whole.code == 0
    for moment in kills(times, whole, "migrate"):
        url = databases.like(first)
        command(killable, url, "attempts", "migrate", **moment)
        check_sound(url)
        engine = database.unmigrated_database(url)
        with engine.connect() as connection:
            revisions = database.revisions_of(connection)
            count = connection.scalar(text("SELECT count(*) FROM attempts"))
        engine.dispose()
        assert revisions.found in ("0001", revisions.known)
        assert count == 2
        states["new" if revisions.found == revisions.known else "old"] += 1
        assert command(killable, url, "attempts", "migrate").code == 0
        check_whole(url)
    figure(f"{times} kills of migrate on {databases.kind}: {dict(states)}")
