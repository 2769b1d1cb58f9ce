"""The file of an SQLite database: open, copy and replace it while other programs may use it."""

import os
import secrets
import shutil
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from glob import escape
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Engine, event
from sqlalchemy.exc import SQLAlchemyError

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
