"""Overwriting what was deleted, where it is still written: in SQLite's file of late changes.

SQLite writes changes to a file beside the database, ``-wal``, and later to the database itself.
What was deleted is in that file until the file is emptied, for which no other connection may read.
"""

import time
from contextlib import suppress
from pathlib import Path
from typing import Final

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

# Milliseconds in which nobody else can write, while readers are waited for.
_WAIT: Final = 100
# How often that is tried before the caller is told, and the seconds in between.
_TRIES: Final = 8
_PAUSE: Final = 0.2


def overwrite_deleted(engine: Engine, tries: int = _TRIES) -> bool | None:
    """Overwrite what was deleted; return False if a reader still keeps it in the file ``-wal``.

    PostgreSQL overwrites in its own time: None.
    """
    if engine.dialect.name != "sqlite":
        return None
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        before = connection.exec_driver_sql("PRAGMA busy_timeout").scalar_one()
        connection.exec_driver_sql(f"PRAGMA busy_timeout = {_WAIT}")
        try:
            for _ in range(tries - 1):
                if _is_emptied(connection):
                    return True
                time.sleep(_PAUSE)
            return _is_emptied(connection)
        finally:
            connection.exec_driver_sql(f"PRAGMA busy_timeout = {before}")


def finish_overwriting(engine: Engine) -> None:
    """Empty SQLite's file of late changes where it can be done now, whoever has deleted.

    Where it cannot, the next call may.
    """
    if engine.dialect.name != "sqlite":
        return
    with suppress(SQLAlchemyError, OSError):
        with engine.connect() as connection:
            path = connection.exec_driver_sql("PRAGMA database_list").one()[2]
        late_changes = Path(f"{path}-wal")
        if late_changes.exists() and late_changes.stat().st_size:
            overwrite_deleted(engine, 1)


def _is_emptied(connection: Connection) -> bool:
    busy, _, _ = connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)").one()
    return not busy
