"""The file of an SQLite database, which must not be moved or replaced while it is open."""

import os
import sqlite3
from contextlib import closing, suppress
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Connection, Engine, event
from sqlalchemy.exc import SQLAlchemyError

# Only the owner may read and write the file: it contains answers of learners.
_OWN: Final = 0o600


class MisplacedFileError(SQLAlchemyError):
    """The open file is no longer at its path."""


class DatabaseFile:
    """Refuses connections and commits after the file of a database was deleted or replaced."""

    def __init__(self, engine: Engine) -> None:
        self._path = Path()
        self._identity: tuple[int, int] | None = None
        # A later connection must not create a new file, and no commit to a lost file may succeed.
        event.listen(engine, "do_connect", self._before_connect)
        event.listen(engine, "begin", self._check)
        event.listen(engine, "commit", self._check)

    def note(self, connection: Connection) -> str:
        """Remember the file of the connection. Return its path, or "" for a database in memory."""
        path: str = connection.exec_driver_sql("PRAGMA database_list").one()[2]
        if path:
            self._path = Path(path)
            self._identity = _identity(self._path)
        return path

    def _before_connect(self, *_: Any) -> None:
        self._check()

    def _check(self, *_: Any) -> None:
        if self._identity is not None and _identity(self._path) != self._identity:
            raise MisplacedFileError("the file of the database was deleted or replaced")


def make_private(path: str) -> None:
    """Create an empty file that only its owner can read, unless the file exists."""
    # SQLite itself reports errors when it opens the file.
    with suppress(OSError):
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, _OWN))


def copy_into(source: Path, target: Path) -> None:
    """Copy an SQLite database into a new file, which only its owner may read.

    Other programs may read and write the database meanwhile. Raises sqlite3.Error.
    """
    make_private(str(target))
    uri = f"{source.absolute().as_uri()}?mode=ro"
    with closing(sqlite3.connect(uri, uri=True, isolation_level=None)) as connection:
        connection.execute("VACUUM INTO ?", (str(target),))


def is_in_use(path: Path) -> bool:
    """True if another program has the SQLite database open."""
    # If no program has it open, closing writes the write-ahead log into the database.
    with closing(sqlite3.connect(path, timeout=0, isolation_level=None)) as connection:
        try:
            # In WAL mode every open connection holds a lock that excludes this one.
            connection.execute("PRAGMA locking_mode = EXCLUSIVE")
            connection.execute("BEGIN EXCLUSIVE")
            connection.execute("COMMIT")
        except sqlite3.OperationalError:
            return True
        except sqlite3.DatabaseError:
            # The file is damaged, so no program can have it open.
            return False
    return False


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino
