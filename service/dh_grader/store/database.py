"""The database: opened, migrated, copied, erased, and written to by one thread.

It also has the queue of scores that go to platforms; ``lti/outbox.py`` sends them. Attempts are
recorded and read in the other files.
"""

import asyncio
import logging
import os
import queue
import secrets
import shutil
import sqlite3
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from enum import IntEnum
from glob import escape
from math import inf
from pathlib import Path
from time import monotonic, sleep
from typing import Any, Final, TypeVar

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import (
    ColumnElement,
    Connection,
    Engine,
    bindparam,
    case,
    create_engine,
    event,
    literal,
    make_url,
    select,
    text,
    update,
)
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.exc import ArgumentError, DBAPIError, SQLAlchemyError

from dh_grader.store import StoreDownError, UnusableDatabaseError
from dh_grader.store.tables import UtcTime, attempts, contexts, learners, line_items, scores
from dh_grader.translations import Sentence, joined, say

# --- Open and migrate a database, and run transactions


R = TypeVar("R")

_log = logging.getLogger(__name__)

_MIGRATIONS: Final = Path(__file__).parent / "migrations"
# How long a statement waits for another process that is writing (seconds).
_LOCK_WAIT: Final = 5.0
# How long a starting process waits for another one that migrates SQLite (milliseconds).
_MIGRATION_WAIT: Final = 600_000
# The PostgreSQL advisory lock that lets only one of several starting processes migrate.
_MIGRATION_LOCK: Final = 0x6468_6772
# The most tries of a transaction after deadlocks (PostgreSQL, appendix A, "deadlock_detected").
_TRANSACTION_TRIES: Final = 5
_DEADLOCK: Final = "40P01"
# Give up a server whose machine is gone after half a minute (libpq, "keepalives_idle" and
# following). By default TCP would wait a quarter of an hour.
_WHEN_SILENT: Final = {
    "keepalives_idle": 10,
    "keepalives_interval": 5,
    "keepalives_count": 3,
    "tcp_user_timeout": 25_000,
}


@dataclass(frozen=True, slots=True)
class Revisions:
    """The revision of a database's tables (None without tables), and that of this program."""

    found: str | None
    known: str
    # True if the tables are those of a newer version of the program.
    is_newer: bool = False


def open_database(url: str, *, create: bool = True, migrate: bool = True) -> Engine:
    """Open the database at the URL, with the tables of this version of the program.

    ``url`` is an SQLAlchemy URL or the path of an SQLite file. With ``create``, a missing file and
    missing tables are created. With ``migrate``, older tables are updated. Raises
    UnusableDatabaseError.
    """
    engine, _ = _opened(url, create=create, migrate=migrate)
    return engine


def migrate_database(url: str) -> Revisions:
    """Create or update the tables at the URL; return the revision before and that of this program.

    Raises UnusableDatabaseError.
    """
    engine, revisions = _opened(url, create=True, migrate=True)
    engine.dispose()
    return revisions


def _opened(url: str, *, create: bool, migrate: bool) -> tuple[Engine, Revisions]:
    engine = unmigrated_database(url)
    if (path := file_of(engine)) is not None and not path.exists():
        _check_missing(engine, path, create=create)
        make_private(str(path))
    try:
        with engine.connect() as connection:
            if _is_in_memory(connection):
                raise UnusableDatabaseError(say("would be kept in memory and lost; name a file"))
            connection.rollback()
            revisions = revisions_of(connection)
            connection.rollback()
            if revisions.found != revisions.known:
                if not (migrate or (create and revisions.found is None)):
                    raise UnusableDatabaseError(_at(engine, unfit(revisions)))
                revisions = _migrate(connection)
    except ValueError as error:
        raise UnusableDatabaseError(say("has parts that the database does not know")) from error
    except SQLAlchemyError as error:
        raise UnusableDatabaseError(_at(engine, reason(error))) from error
    finally:
        engine.dispose()
    return engine, revisions


def _check_missing(engine: Engine, path: Path, *, create: bool) -> None:
    # After a killed restore, no program may begin with an empty database.
    kept = before(path)
    if kept.exists():
        problem = say(
            "there is no such file, but {kept} is there, the database from before a restore. Run "
            "dh-grader restore again, or move {kept} back to {file}, or away",
            kept=str(kept),
            file=str(path),
        )
        raise UnusableDatabaseError(_at(engine, problem))
    for left in unfinished(path):
        problem = say(
            "there is no such file, but {left} is there: a restore was interrupted. Run dh-grader "
            "restore again, or delete {left}",
            left=str(left),
        )
        raise UnusableDatabaseError(_at(engine, problem))
    if not create:
        raise UnusableDatabaseError(_at(engine, say("there is no such file")))


def _is_in_memory(connection: Connection) -> bool:
    if connection.dialect.name != "sqlite":
        return False
    return not connection.exec_driver_sql("PRAGMA database_list").one()[2]


def file_of(engine: Engine) -> Path | None:
    """Return the file of an SQLite database; None for PostgreSQL, and for an URI of SQLite."""
    path = engine.url.database or ""
    return Path(path) if engine.dialect.name == "sqlite" and is_plain(path) else None


def revisions_of(connection: Connection) -> Revisions:
    """Return the revision of the tables, and that of this version of the program."""
    return compared(MigrationContext.configure(connection).get_current_revision())


def compared(found: str | None) -> Revisions:
    """Compare the revision of a database's tables with that of this version of the program."""
    scripts = ScriptDirectory.from_config(_config())
    known = scripts.get_current_head()
    assert known is not None
    all_known = {script.revision for script in scripts.walk_revisions()}
    return Revisions(found, known, found is not None and found not in all_known)


def unfit(revisions: Revisions) -> Sentence:
    """Say why this version of the program cannot use tables of another revision, and what to do."""
    if revisions.is_newer:
        return say(
            "its tables ({found}) are those of a newer version of the program; this version knows "
            "tables up to {known}",
            found=str(revisions.found),
            known=revisions.known,
        )
    if revisions.found is None:
        return say("it has no tables. Create them: dh-grader attempts migrate")
    return say(
        "its tables ({found}) are those of an older version of the program; this version needs "
        "{known}. Back up the database, stop services of the older version, and run: dh-grader "
        "attempts migrate",
        found=revisions.found,
        known=revisions.known,
    )


def unmigrated_database(url: str) -> Engine:
    """Open the database at the URL without a migration. Raises UnusableDatabaseError."""
    try:
        return _engine(url)
    except (ArgumentError, ValueError) as error:
        # Do not repeat the URL: it may contain a password.
        problem = say("is no URL of a database and no path of a file")
        raise UnusableDatabaseError(problem) from error


def _at(engine: Engine, problem: str) -> str:
    return joined(": ", [safe_url(engine), problem])


def _engine(url: str) -> Engine:
    parsed = make_url(url if "://" in url else f"sqlite:///{url}")
    match parsed.get_backend_name():
        case "sqlite" if parsed.drivername in ("sqlite", "sqlite+pysqlite"):
            engine = create_engine(
                parsed, connect_args={"timeout": _LOCK_WAIT}, hide_parameters=True
            )
            DatabaseFile(engine, _LOCK_WAIT)
            event.listen(engine, "begin", _begin_sqlite)
            return engine
        case "postgresql":
            # The server releases the locks of a client whose machine is gone after a minute.
            options = (
                f"-c lock_timeout={_LOCK_WAIT:.0f}s -c statement_timeout=60s "
                "-c tcp_keepalives_idle=30 -c tcp_keepalives_interval=10 -c tcp_keepalives_count=3"
            )
            return create_engine(
                parsed.set(drivername="postgresql+psycopg"),
                pool_pre_ping=True,
                # Logged errors must not contain answers of students.
                hide_parameters=True,
                connect_args=_WHEN_SILENT | {"connect_timeout": 3, "options": options},
            )
        case _:
            raise UnusableDatabaseError(
                say("{driver} is not supported; use SQLite or PostgreSQL", driver=parsed.drivername)
            )


def _begin_sqlite(connection: Connection) -> None:
    # A deferred transaction that reads first would fail at its first write beside another writer.
    writes = connection.get_execution_options().get("writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def _migrate(connection: Connection) -> Revisions:
    # Return the revision before. Raises UnusableDatabaseError for tables of a newer version.
    connection = connection.execution_options(writes=True)
    with _patient(connection), connection.begin():
        without_time_limit(connection)
        if connection.dialect.name == "postgresql":
            lock = text("SELECT pg_advisory_xact_lock(:key)")
            connection.execute(lock, {"key": _MIGRATION_LOCK})
        # Another process may have migrated meanwhile.
        revisions = revisions_of(connection)
        if revisions.is_newer:
            raise UnusableDatabaseError(_at(connection.engine, unfit(revisions)))
        if revisions.found == revisions.known:
            return revisions
        config = _config()
        config.attributes["connection"] = connection
        command.upgrade(config, "head")
    if revisions.found is not None:
        # At its start, the service has not set up its log yet: only warnings are written.
        _log.warning("The tables were migrated from %s to %s", revisions.found, revisions.known)
    return revisions


def _config() -> Config:
    config = Config()
    config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
    return config


@contextmanager
def _patient(connection: Connection) -> Iterator[None]:
    driver = connection.connection.driver_connection
    if connection.dialect.name != "sqlite" or driver is None:
        yield
        return
    # Not by SQLAlchemy, which would begin a transaction and so wait for the lock.
    driver.execute(f"PRAGMA busy_timeout = {_MIGRATION_WAIT}")
    try:
        yield
    finally:
        driver.execute(f"PRAGMA busy_timeout = {_LOCK_WAIT * 1000:.0f}")


def without_time_limit(connection: Connection) -> None:
    """Remove the time limits of the connection's transaction."""
    if connection.dialect.name == "postgresql":
        for limit in ("lock_timeout", "statement_timeout"):
            connection.exec_driver_sql(f"SET LOCAL {limit} = 0")


def in_transaction(engine: Engine, work: Callable[[Connection], R]) -> R:
    """Run ``work`` in a transaction and return its result; try again after a deadlock."""
    tries = 0
    while True:
        try:
            with engine.connect() as connection:
                connection = connection.execution_options(writes=True)
                with connection.begin():
                    return work(connection)
        except SQLAlchemyError as error:
            tries += 1
            if tries == _TRANSACTION_TRIES or not is_deadlock(error):
                raise


def is_deadlock(error: Exception) -> bool:
    """True if PostgreSQL ended the transaction because of a deadlock."""
    return getattr(getattr(error, "orig", None), "sqlstate", None) == _DEADLOCK


def safe_url(engine: Engine) -> str:
    """The URL of a database without its password."""
    return engine.url.render_as_string(hide_password=True)


def reason(error: SQLAlchemyError) -> str:
    """Return the database driver's error message in one line, without values of rows."""
    said = str(getattr(error, "orig", None) or error).partition("\nDETAIL:")[0]
    return " ".join(said.split())[:300]


# --- The thread that writes to the database, and commits several waiting attempts at once


_SILENT: Final = "the database does not react"

# The most jobs in one transaction, and in the queue before further jobs are refused.
_MAX_TOGETHER: Final = 64
_MAX_WAITING: Final = 4096
# The time until the next call of ``tidy`` after one that failed (seconds).
_TIDY_AGAIN: Final = 60.0
# How long a job waits for the database in all (seconds). A paused server raises no error, and
# waiting for a lock takes up to five seconds.
_TIMEOUT: Final = 15.0
# How long the first of several concurrent jobs waits for others (seconds): a commit for each would
# cost twice the processor time. A client that sends one attempt after the other never waits.
_GATHER: Final = 0.01


@dataclass(frozen=True, slots=True)
class _Job:
    work: Callable[[Connection], Any]
    loop: asyncio.AbstractEventLoop
    done: "asyncio.Future[Any]"


# A job with its result or its exception.
_Finished = tuple[_Job, Any, Exception | None]


class AttemptWriter:
    """Runs jobs (functions that write) in order, many jobs in one transaction.

    A job gets its result only after the commit. A failing job does not affect others.
    """

    def __init__(self, engine: Engine, tidy: Callable[[], float] = lambda: 3600.0) -> None:
        """Start the thread, which calls ``tidy``, and again after the seconds that it returns."""
        self._engine = engine
        self._tidy = tidy
        self._tidy_at = monotonic()
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        # The start of the current transaction; None while the thread is idle.
        self._begun_at: float | None = None
        # The time of the last job that the database failed or refused, or that waited too long.
        self.failed_at = -inf
        self._thread = threading.Thread(target=self._run, name="attempts", daemon=True)
        self._thread.start()

    async def run(self, work: Callable[[Connection], R]) -> R:
        """Return the result of ``work`` after its commit. Raises StoreDownError."""
        begun_at = self._begun_at
        if begun_at is not None and monotonic() - begun_at > _TIMEOUT:
            raise self._failed(_SILENT)
        if self._jobs.qsize() >= _MAX_WAITING:
            raise self._failed("too many attempts wait to be written")
        loop = asyncio.get_running_loop()
        job = _Job(work, loop, loop.create_future())
        self._jobs.put(job)
        try:
            async with asyncio.timeout(_TIMEOUT):
                result: R = await job.done
        except TimeoutError as error:
            raise self._failed(_SILENT) from error
        return result

    def _failed(self, why: str) -> StoreDownError:
        self.failed_at = monotonic()
        return StoreDownError(why)

    def close(self) -> None:
        """Flush pending jobs and stop the writer thread."""
        self._jobs.put(None)
        self._thread.join()

    def _run(self) -> None:
        ended = is_busy = False
        while not ended:
            jobs, ended = self._waiting(_GATHER if is_busy else 0)
            # Skip jobs whose caller has gone.
            jobs = [job for job in jobs if not job.done.cancelled()]
            if jobs:
                self._process(jobs)
                self._begun_at = None
                is_busy = len(jobs) > 1
            if monotonic() >= self._tidy_at and not ended:
                pause = _TIDY_AGAIN
                try:
                    pause = self._tidy()
                except Exception:  # noqa: BLE001 - recording must go on
                    _log.exception("The database could not be tidied up")
                self._tidy_at = monotonic() + pause

    def _waiting(self, gather: float) -> tuple[list[_Job], bool]:
        jobs: list[_Job] = []
        try:
            found = self._jobs.get(timeout=max(0.0, self._tidy_at - monotonic()))
        except queue.Empty:
            return jobs, False
        if gather and found is not None:
            sleep(gather)
        while found is not None:
            jobs.append(found)
            if len(jobs) == _MAX_TOGETHER:
                return jobs, False
            try:
                found = self._jobs.get_nowait()
            except queue.Empty:
                return jobs, False
        return jobs, True

    def _process(self, jobs: list[_Job]) -> None:
        self._begun_at = monotonic()
        try:
            results = self._run_together(jobs)
        except Exception as error:  # noqa: BLE001 - each job gets its own exception
            if len(jobs) > 1 and not is_database_failure(error):
                for job in jobs:
                    self._process([job])
                return
            failure = error
            if isinstance(error, SQLAlchemyError):
                failure = StoreDownError(reason(error))
            if isinstance(failure, StoreDownError):
                self.failed_at = monotonic()
            _deliver([(job, None, failure) for job in jobs])
            return
        _deliver([(job, result, None) for job, result in zip(jobs, results, strict=True)])

    def _run_together(self, jobs: list[_Job]) -> list[Any]:
        with self._engine.connect() as connection:
            connection = connection.execution_options(writes=True)
            with connection.begin():
                return [job.work(connection) for job in jobs]


def _deliver(finished: list[_Finished]) -> None:
    by_loop: dict[asyncio.AbstractEventLoop, list[_Finished]] = defaultdict(list)
    for each in finished:
        by_loop[each[0].loop].append(each)
    for loop, jobs in by_loop.items():
        # A closed loop has no callers.
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(_resolve, jobs)


def _resolve(finished: list[_Finished]) -> None:
    for job, result, failure in finished:
        if job.done.done():
            continue
        if failure is None:
            job.done.set_result(result)
        else:
            job.done.set_exception(failure)


def is_database_failure(error: Exception) -> bool:
    """True if the database itself failed, so that an immediate retry would fail, too."""
    # Transactions of several attempts may deadlock; run one by one, they do not.
    if is_deadlock(error):
        return False
    return isinstance(error, SQLAlchemyError) and (
        not isinstance(error, DBAPIError)
        or error.connection_invalidated
        or type(error).__name__ in ("OperationalError", "InternalError", "InterfaceError")
    )


# --- The file of an SQLite database: open, copy and replace it while other programs may use it


# Only the owner may read and write the file: it contains answers of learners.
_OWN: Final = 0o600
# SQLite cuts a larger write-ahead log to this size (bytes) when it next writes from the start. A
# usual log has 1,000 pages.
LARGE_LOG: Final = 8 * 1024 * 1024
# Overwrite deleted and replaced rows, so that no data of a deleted learner stays in the file.
_SETTINGS: Final = (
    "synchronous = FULL",
    "foreign_keys = ON",
    "secure_delete = ON",
    f"journal_size_limit = {LARGE_LOG}",
)
# The end of the name of a copy that is not yet in its place.
_PART: Final = ".part"


class MisplacedFileError(SQLAlchemyError):
    """The open file is no longer at its path."""


class InUseError(Exception):
    """Another program has the database open."""


class DatabaseFile:
    """Sets up connections, and refuses connections and commits after the file was replaced.

    ``wait`` is how long a new connection waits for another process (seconds).
    """

    def __init__(self, engine: Engine, wait: float) -> None:
        path = engine.url.database or ""
        self._path = Path(path).absolute() if is_plain(path) else None
        self._identity: tuple[int, int] | None = None
        self._wait = wait
        # A later connection must not create a new file, and no commit to a lost file may succeed.
        event.listen(engine, "do_connect", self._before_connect)
        event.listen(engine, "connect", self._set_up)
        event.listen(engine, "begin", self._check)
        event.listen(engine, "commit", self._check)

    def _before_connect(self, *_: Any) -> None:
        # If the file has the same identity after it was opened, this is the file that was opened.
        if self._identity is None and self._path is not None:
            self._identity = _identity(self._path)
        self._check()

    def _check(self, *_: Any) -> None:
        if self._identity is None or self._path is None:
            return
        if _identity(self._path) != self._identity:
            raise MisplacedFileError("the file of the database was deleted or replaced")

    def _set_up(self, connection: Any, _: object) -> None:
        # SQLAlchemy begins transactions; Python's driver must not do so on its own.
        connection.isolation_level = None
        cursor = connection.cursor()
        if self._identity is None:
            path = cursor.execute("PRAGMA database_list").fetchone()[2]
            if path:
                self._path, self._identity = Path(path), _identity(Path(path))
        self._use_write_ahead_log(cursor)
        for setting in _SETTINGS:
            cursor.execute(f"PRAGMA {setting}")
        cursor.close()

    def _use_write_ahead_log(self, cursor: sqlite3.Cursor) -> None:
        # SQLite does not wait for its lock here, so try again if another process has the file.
        until = time.monotonic() + self._wait
        while True:
            # The other process may have replaced the file. A log that belongs to the replaced file
            # would get the name of the new file's log.
            self._check()
            try:
                cursor.execute("PRAGMA journal_mode = WAL")
            except sqlite3.OperationalError as error:
                if not _is_busy(error) or time.monotonic() > until:
                    raise
                time.sleep(0.01)
            else:
                return


def is_plain(path: str) -> bool:
    """True if SQLite takes the text as the path of a file: not as a URI, and not as memory."""
    return bool(path) and not path.startswith((":", "file:"))


def make_private(path: str) -> None:
    """Create an empty file that only its owner can read, unless the file exists."""
    # SQLite itself reports errors when it opens the file.
    with suppress(OSError):
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, _OWN))


def before(path: Path) -> Path:
    """Return the place of the database that a restore has replaced."""
    return path.with_name(f"{path.name}.before")


def unfinished(path: Path) -> list[Path]:
    """Return what killed commands have left of their copies for the file at ``path``."""
    return sorted(path.parent.glob(f"{escape(path.name)}.{'[0-9a-f]' * 8}{_PART}*"))


@contextmanager
def copy_of(source: Path, target: Path) -> Iterator[Path]:
    """Copy an SQLite database into a new file beside ``target``, and return its path.

    The copy is on the disk as a whole, and only its owner may read it. The caller moves it to its
    place; otherwise it is deleted. Other programs may read and write the database meanwhile.
    Raises sqlite3.Error, OSError.
    """
    for left in unfinished(target):
        left.unlink(missing_ok=True)
    part = _new_part(target)
    uri = f"{source.absolute().as_uri()}?mode=ro"
    if _is_read_only(source) and not any(log.exists() for log in _logs(source)):
        # SQLite cannot make its log there, and no program can change the file.
        uri += "&immutable=1"
    try:
        with closing(sqlite3.connect(uri, uri=True, isolation_level=None)) as connection:
            connection.execute("VACUUM INTO ?", (str(part),))
        _flush(part)
        yield part
    finally:
        part.unlink(missing_ok=True)


def move_to_free_place(copy: Path, target: Path) -> None:
    """Move a file to a path where there is no file. Raises FileExistsError, OSError."""
    try:
        os.link(copy, target)
    except FileExistsError:
        raise
    except OSError:
        # This file system has no hard links.
        if target.exists():
            raise FileExistsError(str(target)) from None
        copy.rename(target)
    _flush(target.parent)


def replace_database(copy: Path, target: Path) -> None:
    """Put ``copy`` into the place of the SQLite database ``target``, in one step.

    At any moment, the old or the new database is at ``target`` as a whole. The old one is kept as
    ``before(target)``; if that is another file, raise FileExistsError. Raises InUseError if another
    program has the old one open, sqlite3.Error and OSError.
    """
    kept = before(target)
    with _alone(target) as connection:
        if target.exists():
            # A restore that was killed between its two steps has left a second name of the file.
            if kept.exists() and kept.samefile(target):
                kept.unlink()
            _keep(connection, target, kept)
        # Only a damaged or a deleted database still has logs. SQLite would replay them over the
        # new file.
        for log, kept_log in zip(_logs(target), _logs(kept), strict=True):
            if log.exists():
                log.replace(kept_log)
        _flush(target.parent)
        copy.replace(target)
        _flush(target.parent)


@contextmanager
def _alone(path: Path) -> Iterator[sqlite3.Connection | None]:
    # Yields a connection that excludes all others; None if the file is missing or damaged.
    if not path.exists():
        yield None
        return
    # If no other program has it open, this writes the log into the database and deletes the log.
    with closing(sqlite3.connect(path, timeout=0, isolation_level=None)) as connection:
        try:
            connection.execute("PRAGMA locking_mode = EXCLUSIVE")
            connection.execute("PRAGMA journal_mode = DELETE")
            # The lock stays until the connection is closed.
            connection.execute("BEGIN EXCLUSIVE")
            connection.execute("COMMIT")
        except sqlite3.OperationalError as error:
            if _is_busy(error):
                raise InUseError from error
            raise
        except sqlite3.DatabaseError:
            # No program can have a damaged file open.
            yield None
            return
        yield connection


def _keep(connection: sqlite3.Connection | None, target: Path, kept: Path) -> None:
    try:
        os.link(target, kept)
    except FileExistsError:
        raise
    except OSError:
        # This file system has no hard links. Reading the file otherwise would drop SQLite's lock.
        if kept.exists():
            raise FileExistsError(str(kept)) from None
        part = _new_part(target)
        if connection is not None:
            connection.execute("VACUUM INTO ?", (str(part),))
        else:
            shutil.copyfile(target, part)
        _flush(part)
        part.replace(kept)


def _new_part(target: Path) -> Path:
    # A name of its own: of two commands at once, none may move the half copy of the other.
    part = target.with_name(f"{target.name}.{secrets.token_hex(4)}{_PART}")
    make_private(str(part))
    return part


def _is_read_only(file: Path) -> bool:
    # True if the file is on a read-only disk.
    return hasattr(os, "statvfs") and bool(os.statvfs(file).f_flag & os.ST_RDONLY)


def _is_busy(error: sqlite3.Error) -> bool:
    return error.sqlite_errorcode & 0xFF in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)


def _logs(file: Path) -> list[Path]:
    # SQLite writes changes to these files beside the database.
    return [file.with_name(f"{file.name}{end}") for end in ("-wal", "-shm", "-journal")]


def _flush(path: Path) -> None:
    # Write a file, or the names in a folder, to the disk. Windows has no such call for folders.
    if os.name != "posix" and path.is_dir():
        return
    file = os.open(path, os.O_RDONLY if os.name == "posix" else os.O_RDWR)
    try:
        os.fsync(file)
    finally:
        os.close(file)


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


# --- Erase deleted rows from SQLite's write-ahead log (the file ``-wal``)
#
# Deleted rows stay in the log until it is truncated, which is possible only while nobody reads.


# How long one try waits for readers and blocks writers (milliseconds).
_WAIT: Final = 100
# The seconds between two such tries of a service.
_INTERVAL: Final = 60.0
# How often a service looks for a large log (seconds), and how long it then waits (milliseconds).
_LOOK: Final = 1.0
_SHORT_WAIT: Final = 5
# The number of tries before the caller gets False, and the seconds in between.
_ERASURE_TRIES: Final = 8
_PAUSE: Final = 0.2


def overwrite_deleted(
    engine: Engine, tries: int = _ERASURE_TRIES, wait: int = _WAIT
) -> bool | None:
    """Truncate SQLite's write-ahead log; return False if a reader prevents it.

    Each of the tries waits for ``wait`` milliseconds. Return None for PostgreSQL, which overwrites
    deleted rows by itself.
    """
    if engine.dialect.name != "sqlite":
        return None
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        before = connection.exec_driver_sql("PRAGMA busy_timeout").scalar_one()
        connection.exec_driver_sql(f"PRAGMA busy_timeout = {wait}")
        try:
            for _ in range(tries - 1):
                if _truncate(connection):
                    return True
                time.sleep(_PAUSE)
            return _truncate(connection)
        finally:
            connection.exec_driver_sql(f"PRAGMA busy_timeout = {before}")


class LogCutter:
    """Truncates SQLite's write-ahead log every minute, and a large log within seconds.

    While a program reads for long, the log grows and cannot be truncated.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._due = time.monotonic()

    def next(self) -> float:
        """Truncate the log if it is due or large; return the seconds until the next call."""
        if self._engine.dialect.name != "sqlite":
            return _INTERVAL
        is_due = time.monotonic() >= self._due
        with suppress(SQLAlchemyError, OSError):
            size = self._size_of_log()
            if size > LARGE_LOG or (size and is_due):
                overwrite_deleted(self._engine, 1, _WAIT if is_due else _SHORT_WAIT)
        if is_due:
            self._due = time.monotonic() + _INTERVAL
        return _LOOK

    def _size_of_log(self) -> int:
        path = self._engine.url.database or ""
        if not is_plain(path):
            with self._engine.connect() as connection:
                path = connection.exec_driver_sql("PRAGMA database_list").one()[2]
        log = Path(f"{path}-wal")
        return log.stat().st_size if log.exists() else 0


def _truncate(connection: Connection) -> bool:
    busy, _, _ = connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)").one()
    return not busy


# --- The queue of scores to be sent to learning platforms
#
# A row belongs to a learner and a line item (a column of the platform's gradebook). Points are read
# when they are sent, so the last change counts.


# In ``Connection.info``: True if the transaction has queued a score.
QUEUED: Final = "scores_queued"
# How the learners of scores begin that are to be cleared.
FORGOTTEN: Final = "forgotten-"


class Priority(IntEnum):
    """The priority of a queued score; the lowest number is sent first."""

    HAND_IN = 0
    CHANGE = 1
    REGRADE = 2


_COLUMNS: Final = (
    "line_item", "learner", "sub", "max_points", "version", "wanted_at", "state", "priority",
    "tries", "next_try_at",
)  # fmt: skip
# Build the statements once: building one takes longer than running it.
_RECEIVERS: Final = (
    select(
        line_items.c.number,
        learners.c.learner,
        learners.c.sub,
        line_items.c.max_points,
        literal(1).label("version"),
        bindparam("now", type_=UtcTime).label("wanted_at"),
        literal("waiting").label("state"),
        bindparam("priority", type_=scores.c.priority.type).label("priority"),
        literal(0).label("tries"),
        bindparam("now", type_=UtcTime).label("next_try_at"),
    )
    .join_from(line_items, contexts)
    .join(learners, learners.c.registration == contexts.c.registration)
)
_OF_LEARNER: Final = _RECEIVERS.where(
    line_items.c.assignment == bindparam("assignment"), learners.c.learner == bindparam("learner")
)


def _upsert(dialect: Any, chosen: Any) -> Any:
    new = dialect.insert(scores).from_select(_COLUMNS, chosen)
    more_urgent = case(
        (
            (scores.c.state == "waiting") & (scores.c.priority < new.excluded.priority),
            scores.c.priority,
        ),
        else_=new.excluded.priority,
    )
    return new.on_conflict_do_update(
        index_elements=[scores.c.line_item, scores.c.learner],
        set_={
            "sub": new.excluded.sub,
            "version": scores.c.version + 1,
            "wanted_at": new.excluded.wanted_at,
            "state": "waiting",
            "priority": more_urgent,
            "next_try_at": new.excluded.next_try_at,
        },
    )


_DIALECTS: Final = {"postgresql": postgresql, "sqlite": sqlite}
_QUEUE_ONE: Final = {name: _upsert(each, _OF_LEARNER) for name, each in _DIALECTS.items()}


def queue_score(
    connection: Connection, assignment: int | None, learner: str, priority: Priority
) -> None:
    """Queue the score of a learner in an assignment, if a platform has a column for this score."""
    if assignment is not None:
        _queue(
            connection,
            _QUEUE_ONE[connection.dialect.name],
            priority,
            assignment=assignment,
            learner=learner,
        )


def queue_scores(
    connection: Connection, chosen: ColumnElement[bool], priority: Priority = Priority.CHANGE
) -> None:
    """Queue the scores of the chosen attempts; ``chosen`` is an SQL condition."""
    having = select(attempts.c.assignment, attempts.c.learner).where(
        chosen, attempts.c.assignment.is_not(None)
    )
    having_them = having.distinct().subquery()
    receivers = _RECEIVERS.join(
        having_them,
        (having_them.c.assignment == line_items.c.assignment)
        & (having_them.c.learner == learners.c.learner),
    )
    # SQLite reads "ON CONFLICT" after a join as a part of the join, unless there is a WHERE.
    receivers = receivers.where(line_items.c.number.is_not(None))
    _queue(connection, _upsert(_DIALECTS[connection.dialect.name], receivers), priority)


def forget_scores(connection: Connection, learner: str) -> None:
    """Delete a learner's scores: at the platforms if they were sent, else in the queue."""
    mine = scores.c.learner == learner
    connection.execute(scores.delete().where(mine, scores.c.stamp.is_(None)))
    # The platform's id of the learner stays until the platform has cleared the score.
    now = datetime.now(UTC)
    left = update(scores).where(mine)
    changed = connection.execute(
        left.values(
            learner=FORGOTTEN + secrets.token_hex(16),
            version=scores.c.version + 1,
            points=None,
            submitted_at=None,
            wanted_at=now,
            state="waiting",
            priority=int(Priority.CHANGE),
            next_try_at=now,
            refusal=None,
        )
    )
    if changed.rowcount:
        connection.info[QUEUED] = True


def _queue(connection: Connection, statement: Any, priority: Priority, **more: object) -> None:
    values = {"now": datetime.now(UTC), "priority": int(priority), **more}
    if connection.execute(statement, values).rowcount:
        connection.info[QUEUED] = True
