"""The database of the attempts: opened by its URL, brought to the newest tables, kept durable."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar

from alembic import command
from alembic.config import Config
from alembic.util import CommandError
from sqlalchemy import Connection, Engine, create_engine, event, make_url, text
from sqlalchemy.exc import ArgumentError, SQLAlchemyError

R = TypeVar("R")

_MIGRATIONS: Final = Path(__file__).parent / "migrations"
# So long a statement waits for another process that is writing (seconds).
_LOCK_WAIT: Final = 5.0
# Only one of several processes that start together changes the tables of a PostgreSQL database.
_MIGRATION_LOCK: Final = 0x6468_6772


class StoreDownError(Exception):
    """The database cannot be reached, or cannot write; what was asked for was not done."""


class UnusableDatabaseError(Exception):
    """The URL names no database that can be used; the text says why."""


def open_database(url: str) -> Engine:
    """The database at the URL, with the newest tables.

    ``url`` is that of SQLAlchemy (postgresql://…, sqlite:///…) or the path of an SQLite file.
    Raises UnusableDatabaseError.
    """
    engine = _engine(url)
    try:
        with engine.connect() as connection:
            _migrate(connection)
    except SQLAlchemyError as error:
        raise UnusableDatabaseError(f"{safe_url(engine)}: {reason(error)}") from error
    except CommandError as error:
        newer = "its tables are those of a newer version of the program"
        raise UnusableDatabaseError(f"{safe_url(engine)}: {newer}") from error
    return engine


def _engine(url: str) -> Engine:
    try:
        parsed = make_url(url if "://" in url else f"sqlite:///{url}")
    except ArgumentError as error:
        # The URL may hold a password: it is not repeated.
        raise UnusableDatabaseError("is no URL of a database and no path of a file") from error
    match parsed.get_backend_name():
        case "sqlite":
            engine = create_engine(
                parsed, connect_args={"timeout": _LOCK_WAIT}, hide_parameters=True
            )
            event.listen(engine, "connect", _set_up_sqlite)
            event.listen(engine, "begin", _begin_sqlite)
            return engine
        case "postgresql":
            waits = f"-c lock_timeout={_LOCK_WAIT:.0f}s -c statement_timeout=60s"
            return create_engine(
                parsed.set(drivername="postgresql+psycopg"),
                pool_pre_ping=True,
                # No failure that is logged tells what somebody has answered.
                hide_parameters=True,
                connect_args={"connect_timeout": 3, "options": waits},
            )
        case other:
            raise UnusableDatabaseError(f"{other} is not supported; use SQLite or PostgreSQL")


def _set_up_sqlite(connection: Any, _: object) -> None:
    # Transactions begin where SQLAlchemy says so (below) and not where Python's driver guesses.
    connection.isolation_level = None
    cursor = connection.cursor()
    for setting in ("journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON"):
        cursor.execute(f"PRAGMA {setting}")
    cursor.close()


def _begin_sqlite(connection: Connection) -> None:
    # A transaction that reads first and then writes would fail at once beside another writer.
    writes = connection.get_execution_options().get("writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def _migrate(connection: Connection) -> None:
    """Bring the tables to the newest form; an empty database gets them all."""
    connection = connection.execution_options(writes=True)
    with connection.begin():
        if connection.dialect.name == "postgresql":
            lock = text("SELECT pg_advisory_xact_lock(:key)")
            connection.execute(lock, {"key": _MIGRATION_LOCK})
        config = Config()
        config.set_main_option("script_location", str(_MIGRATIONS).replace("%", "%%"))
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def in_transaction(engine: Engine, work: Callable[[Connection], R]) -> R:
    """The result of ``work``, committed."""
    with engine.connect() as connection:
        connection = connection.execution_options(writes=True)
        with connection.begin():
            return work(connection)


def safe_url(engine: Engine) -> str:
    """The URL without its password."""
    return engine.url.render_as_string(hide_password=True)


def reason(error: SQLAlchemyError) -> str:
    """What the database's driver says, in one line, without the values of a row."""
    said = str(getattr(error, "orig", None) or error).partition("\nDETAIL:")[0]
    return " ".join(said.split())[:300]
