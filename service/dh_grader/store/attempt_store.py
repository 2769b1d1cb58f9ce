"""The store of attempts that the HTTP routes use: recorded, listed, regraded, forgotten.

It knows threads, time limits and failures; the SQL is in the other files of this package.
"""

import asyncio
import tempfile
from collections.abc import Awaitable, Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, nullcontext
from datetime import UTC, datetime
from math import inf
from time import monotonic
from typing import IO, Final, TypeVar

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from dh_grader.contract import ExerciseStatistics
from dh_grader.store import (
    AttemptFilter,
    GradesFormat,
    ListedAttempt,
    RecordedAttempt,
    Standing,
    StoreDownError,
    UnusableDatabaseError,
)
from dh_grader.store.attempts import (
    AttemptAfter,
    fail_if_read_only,
    record_next,
    rehearse,
    standing,
)
from dh_grader.store.database import (
    AttemptWriter,
    LogCutter,
    open_database,
    overwrite_deleted,
    reason,
    safe_url,
)
from dh_grader.store.results import (
    AttemptHistory,
    Counting,
    LearnerData,
    data_of,
    exercise_statistics,
    forget,
    graded_attempts,
    history,
    override,
    page,
    written,
)
from dh_grader.translations import say

R = TypeVar("R")

# How long a successful check counts, unless a job fails meanwhile (seconds).
_CHECKED: Final = 1.0
# The most queries of tutors at once; others wait.
_READERS: Final = 2
# The time limit of a tutor's query, including its wait for others (seconds): longer than the
# limit of a statement in PostgreSQL.
_READ_TIMEOUT: Final = 70.0
# Seconds until a paused export looks whether the store has been closed.
_LONGEST_WAIT: Final = 0.5
# Larger exports are buffered on the disk (bytes).
_IN_MEMORY: Final = 1024 * 1024


class AttemptStore:
    """The recorded attempts of one database.

    Every method raises StoreDownError if the database fails; nothing is written then.
    """

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self._writer: AttemptWriter | None = None
        self._readers: ThreadPoolExecutor | None = None
        # The beginning of the last check that succeeded.
        self._checked_at = -inf
        # Returns a context for the operation of this name, for example to measure it.
        self.measure: Callable[[str], AbstractContextManager[None]] = lambda _: nullcontext()

    @classmethod
    def open(cls, url: str) -> "AttemptStore":
        """Open the store at a URL or in an SQLite file. Raises UnusableDatabaseError."""
        engine = open_database(url)
        try:
            with engine.begin() as connection:
                fail_if_read_only(connection)
        except SQLAlchemyError as error:
            problem = say(
                "{url}: attempts cannot be recorded there: {reason}",
                url=safe_url(engine),
                reason=reason(error),
            )
            raise UnusableDatabaseError(problem) from error
        finally:
            # Child processes that start later must not inherit a connection.
            engine.dispose()
        return cls(engine)

    def start(self) -> None:
        """Start the threads that write and read.

        Call this method in the process that serves requests.
        """
        self._writer = AttemptWriter(self.engine, LogCutter(self.engine).next)
        self._readers = ThreadPoolExecutor(_READERS, "attempts-read")

    def close(self) -> None:
        """Flush pending attempts, stop the threads and close all connections."""
        if self._writer is not None:
            self._writer.close()
            self._writer = None
        readers, self._readers = self._readers, None
        if readers is not None:
            readers.shutdown()
        self.engine.dispose()

    async def standing(
        self,
        exercise: str,
        learner: str,
        owner: str,
        idempotency_key: str | None,
        assignment: int | None = None,
    ) -> Standing:
        """Return a summary of a learner's earlier attempts at an exercise."""
        with self.measure("standing"):
            return await self._running.run(
                lambda connection: standing(
                    connection, exercise, learner, owner, idempotency_key, assignment
                )
            )

    async def record(
        self, before: Standing, attempt_after: AttemptAfter
    ) -> RecordedAttempt | Standing:
        """Call ``attempt_after`` with the learner's earlier attempts, and write its result.

        ``attempt_after`` must be quick, because other jobs wait for it. See ``record_next``.
        """
        with self.measure("record"):
            return await self._running.run(
                lambda connection: record_next(connection, before, attempt_after)
            )

    async def check(self) -> None:
        """Raise StoreDownError unless attempts can be recorded.

        A check writes to the disk, but not more often than once in a second.
        """
        writer, now = self._running, monotonic()
        if writer.failed_at < self._checked_at and now - self._checked_at < _CHECKED:
            return
        with self.measure("check"):
            await writer.run(rehearse)
        self._checked_at = now

    async def page(
        self, wanted: AttemptFilter, cursor: str | None, most: int
    ) -> tuple[list[ListedAttempt], str | None]:
        """Return at most ``most`` attempts, the newest first, and the cursor of the next page.

        Raises BadCursorError.
        """
        return await self.read(lambda connection: page(connection, wanted, cursor, most))

    async def history(self, attempt_id: str) -> AttemptHistory | None:
        """Return an attempt with its answers, reports and overrides; None if the id is unknown."""
        return await self.read(lambda connection: history(connection, attempt_id))

    async def statistics(self, wanted: AttemptFilter) -> ExerciseStatistics:
        """Return the statistics of an exercise from the wanted attempts."""
        return await self.read(lambda connection: exercise_statistics(connection, wanted))

    async def export(
        self,
        wanted: AttemptFilter,
        form: GradesFormat,
        title: str,
        counting: Callable[[str], Counting],
        give_way: Callable[[], Awaitable[None]],
    ) -> IO[bytes]:
        """Return a file with the attempts in a format. The caller closes the file.

        ``give_way`` is awaited after each page of attempts.
        """
        # Python runs one thread at a time. An export without pauses would hold up the thread of the
        # event loop for milliseconds, whenever that has waited for a socket.
        loop = asyncio.get_running_loop()

        def pause() -> None:
            turn = asyncio.run_coroutine_threadsafe(_awaited(give_way), loop)
            while not turn.done() and self._readers is not None:
                wait([turn], _LONGEST_WAIT)
            if not turn.done():
                turn.cancel()
                raise StoreDownError("the store has been closed")
            turn.result()

        return await self.read(
            lambda connection: _file_of(
                written(graded_attempts(connection, wanted, counting, pause), form, title)
            )
        )

    async def override(
        self, attempt_id: str, points: float | None, reason_given: str, author: str
    ) -> ListedAttempt:
        """Override the points of an attempt's report; ``points=None`` withdraws the override.

        Raises UnknownAttemptError, UnusablePointsError.
        """
        now = datetime.now(UTC)

        def work(connection: Connection) -> ListedAttempt:
            override(connection, attempt_id, points, reason_given, author, now)
            found = history(connection, attempt_id)
            assert found is not None
            return found.attempt

        with self.measure("override"):
            return await self._running.run(work)

    async def data_of(self, learner: str) -> LearnerData:
        """Count the records of a learner."""
        return await self.read(lambda connection: data_of(connection, learner))

    async def forget(self, learner: str) -> tuple[LearnerData, bool | None]:
        """Delete a learner's records; return their counts, and True if no trace stays on disk.

        The second value is None for PostgreSQL, which overwrites deleted rows by itself.
        """
        with self.measure("forget"):
            deleted = await self._running.run(lambda connection: forget(connection, learner))
            try:
                erased = await asyncio.to_thread(overwrite_deleted, self.engine)
            except SQLAlchemyError:
                # The rows are deleted, but not yet overwritten.
                erased = False
        return deleted, erased

    async def write(self, work: Callable[[Connection], R]) -> R:
        """Return the result of ``work`` after its commit; see ``AttemptWriter.run``."""
        with self.measure("write"):
            return await self._running.run(work)

    async def read(self, work: Callable[[Connection], R]) -> R:
        """Run ``work``, which only reads, in a thread for reading; return its result."""
        assert self._readers is not None, "the store has not been started"
        loop = asyncio.get_running_loop()
        with self.measure("read"):
            found = loop.run_in_executor(self._readers, self._run_read, work)
            try:
                return await asyncio.wait_for(found, _READ_TIMEOUT)
            except TimeoutError as error:
                raise StoreDownError(
                    f"the database has not answered for {_READ_TIMEOUT:g} s"
                ) from error

    def _run_read(self, work: Callable[[Connection], R]) -> R:
        try:
            with self.engine.connect() as connection:
                return work(connection)
        except SQLAlchemyError as error:
            raise StoreDownError(reason(error)) from error

    @property
    def _running(self) -> AttemptWriter:
        assert self._writer is not None, "the store has not been started"
        return self._writer


async def _awaited(give_way: Callable[[], Awaitable[None]]) -> None:
    await give_way()


def _file_of(lines: Iterable[bytes]) -> IO[bytes]:
    file = tempfile.SpooledTemporaryFile(_IN_MEMORY)  # noqa: SIM115 - the caller closes it
    try:
        file.writelines(lines)
    except BaseException:
        file.close()
        raise
    file.seek(0)
    return file
