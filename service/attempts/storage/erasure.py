"""Erase deleted rows from SQLite's write-ahead log (the file ``-wal``).

Deleted rows stay in the log until it is truncated, which is possible only while nobody reads.
"""

import time
from contextlib import suppress
from pathlib import Path
from typing import Final

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

# How long one try waits for readers and blocks writers (milliseconds).
_WAIT: Final = 100
# The number of tries before the caller gets False, and the seconds in between.
_TRIES: Final = 8
_PAUSE: Final = 0.2


def overwrite_deleted(engine: Engine, tries: int = _TRIES) -> bool | None:
    """Truncate SQLite's write-ahead log; return False if a reader prevents it.

    Return None for PostgreSQL, which overwrites deleted rows by itself.
    """
    if engine.dialect.name != "sqlite":
        return None
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        before = connection.exec_driver_sql("PRAGMA busy_timeout").scalar_one()
        connection.exec_driver_sql(f"PRAGMA busy_timeout = {_WAIT}")
        try:
            for _ in range(tries - 1):
                if _truncate(connection):
                    return True
                time.sleep(_PAUSE)
            return _truncate(connection)
        finally:
            connection.exec_driver_sql(f"PRAGMA busy_timeout = {before}")


def finish_overwriting(engine: Engine) -> None:
    """Truncate SQLite's write-ahead log if possible."""
    if engine.dialect.name != "sqlite":
        return
    with suppress(SQLAlchemyError, OSError):
        with engine.connect() as connection:
            path = connection.exec_driver_sql("PRAGMA database_list").one()[2]
        log = Path(f"{path}-wal")
        if log.exists() and log.stat().st_size:
            overwrite_deleted(engine, 1)


def _truncate(connection: Connection) -> bool:
    busy, _, _ = connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)").one()
    return not busy
