"""Open the database of attempts by its URL, and migrate its tables."""

import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, TypeVar

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util import CommandError
from sqlalchemy import Connection, Engine, create_engine, event, make_url, text
from sqlalchemy.exc import ArgumentError, SQLAlchemyError

from service.attempts.errors import UnusableDatabaseError
from service.attempts.storage.database_file import DatabaseFile, make_private
from service.translations import joined, say

R = TypeVar("R")

_MIGRATIONS: Final = Path(__file__).parent / "migrations"
# How long a statement waits for another process that is writing (seconds).
_LOCK_WAIT: Final = 5.0
# How long a starting process waits for another one that migrates SQLite (milliseconds).
_MIGRATION_WAIT: Final = 600_000
# The PostgreSQL advisory lock that lets only one of several starting processes migrate.
_MIGRATION_LOCK: Final = 0x6468_6772
# The most tries of a transaction after deadlocks (PostgreSQL, appendix A, "deadlock_detected").
_TRIES: Final = 5
_DEADLOCK: Final = "40P01"
# Give up a server whose machine is gone after half a minute (libpq, "keepalives_idle" and
# following). By default TCP would wait a quarter of an hour.
_WHEN_SILENT: Final = {
    "keepalives_idle": 10,
    "keepalives_interval": 5,
    "keepalives_count": 3,
    "tcp_user_timeout": 25_000,
}


def open_database(url: str, *, create: bool = True) -> Engine:
    """Open the database at the URL and migrate it to the newest tables.

    ``url`` is an SQLAlchemy URL or the path of an SQLite file. With ``create``, a missing file is
    created. Raises UnusableDatabaseError.
    """
    engine = unmigrated_database(url)
    is_sqlite = engine.dialect.name == "sqlite"
    if is_sqlite and not _is_there(path := engine.url.database or ""):
        if not create:
            raise UnusableDatabaseError(_at(engine, say("there is no such file")))
        make_private(path)
    try:
        file = DatabaseFile(engine) if is_sqlite else None
        with engine.connect() as connection:
            if file is not None and not file.note(connection):
                raise UnusableDatabaseError(say("would be kept in memory and lost; name a file"))
            connection.rollback()
            _migrate(connection)
    except ValueError as error:
        raise UnusableDatabaseError(say("has parts that the database does not know")) from error
    except SQLAlchemyError as error:
        raise UnusableDatabaseError(_at(engine, reason(error))) from error
    except CommandError as error:
        newer = say("its tables are those of a newer version of the program")
        raise UnusableDatabaseError(_at(engine, newer)) from error
    finally:
        engine.dispose()
    return engine


def migration_state(connection: Connection) -> tuple[str | None, str | None]:
    """Return the version of the tables (None without tables) and the newest version."""
    config = Config()
    config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
    newest = ScriptDirectory.from_config(config).get_current_head()
    return MigrationContext.configure(connection).get_current_revision(), newest


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


def _is_there(path: str) -> bool:
    # Leave other spellings to SQLite: file:attempts.db?mode=ro, :memory:.
    return path.startswith((":", "file:")) or not path or Path(path).exists()


def _engine(url: str) -> Engine:
    parsed = make_url(url if "://" in url else f"sqlite:///{url}")
    match parsed.get_backend_name():
        case "sqlite" if parsed.drivername in ("sqlite", "sqlite+pysqlite"):
            engine = create_engine(
                parsed, connect_args={"timeout": _LOCK_WAIT}, hide_parameters=True
            )
            event.listen(engine, "connect", _set_up_sqlite)
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


def _set_up_sqlite(connection: Any, _: object) -> None:
    # SQLAlchemy begins transactions (below); Python's driver must not do so on its own.
    connection.isolation_level = None
    cursor = connection.cursor()
    _use_write_ahead_log(cursor)
    # Overwrite deleted and replaced rows, so that no data of a deleted learner stays in the file.
    for setting in ("synchronous = FULL", "foreign_keys = ON", "secure_delete = ON"):
        cursor.execute(f"PRAGMA {setting}")
    cursor.close()


def _use_write_ahead_log(cursor: sqlite3.Cursor) -> None:
    # SQLite does not wait for its lock here, so try again if another process has the file.
    until = time.monotonic() + _LOCK_WAIT
    while True:
        try:
            cursor.execute("PRAGMA journal_mode = WAL")
        except sqlite3.OperationalError as error:
            busy = error.sqlite_errorcode & 0xFF == sqlite3.SQLITE_BUSY
            if not busy or time.monotonic() > until:
                raise
            time.sleep(0.01)
        else:
            return


def _begin_sqlite(connection: Connection) -> None:
    # A deferred transaction that reads first would fail at its first write beside another writer.
    writes = connection.get_execution_options().get("writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def _migrate(connection: Connection) -> None:
    connection = connection.execution_options(writes=True)
    with _patient(connection), connection.begin():
        without_time_limit(connection)
        if connection.dialect.name == "postgresql":
            lock = text("SELECT pg_advisory_xact_lock(:key)")
            connection.execute(lock, {"key": _MIGRATION_LOCK})
        config = Config()
        config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


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
            if tries == _TRIES or not is_deadlock(error):
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
