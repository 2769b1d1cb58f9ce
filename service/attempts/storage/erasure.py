"""Erase deleted rows from SQLite's write-ahead log (the file ``-wal``).

Deleted rows stay in the log until it is truncated, which is possible only while nobody reads.
"""

import time
from contextlib import suppress
from pathlib import Path
from typing import Final

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from service.attempts.storage.database_file import LARGE_LOG, is_plain

# How long one try waits for readers and blocks writers (milliseconds).
_WAIT: Final = 100
# The seconds between two such tries of a service.
_INTERVAL: Final = 60.0
# How often a service looks for a large log (seconds), and how long it then waits (milliseconds).
_LOOK: Final = 1.0
_SHORT_WAIT: Final = 5
# The number of tries before the caller gets False, and the seconds in between.
_TRIES: Final = 8
_PAUSE: Final = 0.2


def overwrite_deleted(engine: Engine, tries: int = _TRIES, wait: int = _WAIT) -> bool | None:
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
