"""The file of an SQLite database, which must stay in its place while it is open."""

import os
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Connection, Engine, event
from sqlalchemy.exc import SQLAlchemyError

# Read and written by its owner alone: it holds what learners have answered.
_OWN: Final = 0o600


class MisplacedFileError(SQLAlchemyError):
    """The file that is open no longer stands at its path."""


class DatabaseFile:
    """Watches over the file of an engine's database.

    SQLite goes on writing to a file that was deleted or replaced, and nobody finds that again.
    """

    def __init__(self, engine: Engine) -> None:
        self._path = Path()
        self._identity: tuple[int, int] | None = None
        # No connection that is opened later may make a file, and no commit be told of as durable.
        event.listen(engine, "do_connect", self._before_connect)
        event.listen(engine, "begin", self._check)
        event.listen(engine, "commit", self._check)

    def note(self, connection: Connection) -> str:
        """Take the file that the connection has open for the right one; its path, if it has any."""
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
    """Make an empty file that only its owner reads, where there is none.

    An empty file is an empty database, and SQLite gives the files beside it the same mode. A file
    that is there keeps its own; where none can be made, SQLite says why.
    """
    with suppress(OSError):
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, _OWN))


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino
