"""Open the database of attempts by its URL, and migrate its tables."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeVar

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine, create_engine, event, make_url, text
from sqlalchemy.exc import ArgumentError, SQLAlchemyError

from service.attempts.errors import UnusableDatabaseError
from service.attempts.storage.database_file import (
    DatabaseFile,
    before,
    is_plain,
    make_private,
    unfinished,
)
from service.translations import Sentence, joined, say

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
