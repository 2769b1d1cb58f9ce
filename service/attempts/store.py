"""The store of attempts: what a route of the service asks of it."""

import asyncio
import tempfile
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from datetime import UTC, datetime
from typing import IO, Final, TypeVar

from sqlalchemy import Connection, Engine, false, update
from sqlalchemy.exc import SQLAlchemyError

from service.attempts.attempt import (
    AttemptFilter,
    GradesFormat,
    ListedAttempt,
    RecordedAttempt,
    Standing,
)
from service.attempts.errors import StoreDownError, UnusableDatabaseError
from service.attempts.recording import AttemptAfter, record_next, standing
from service.attempts.results.grades import Counting, graded_attempts, written
from service.attempts.results.listing import AttemptHistory, history, page
from service.attempts.results.statistics import exercise_statistics
from service.attempts.storage.database import open_database, reason, safe_url
from service.attempts.storage.erasure import finish_overwriting, overwrite_deleted
from service.attempts.storage.tables import attempts
from service.attempts.storage.writer import AttemptWriter
from service.attempts.tutoring import (
    LearnerData,
    data_of,
    forget,
    override,
)
from service.contract.statistics import ExerciseStatistics

R = TypeVar("R")

# Changes no row, and fails where the tables are missing or may not be written to.
_ALIVE: Final = update(attempts).values(number=attempts.c.number).where(false())
# So many tutors read at once; others wait.
_READERS: Final = 2
# How long a tutor's reading may take, its wait for others included (seconds): longer than a
# statement may take in PostgreSQL.
_READING: Final = 70.0
# An export that is larger waits for its reader on the disk (bytes).
_IN_MEMORY: Final = 1024 * 1024


class AttemptStore:
    """The recorded attempts of one database.

    Every method raises StoreDownError where the database fails; what it was to write is then not
    written.
    """

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self._writer: AttemptWriter | None = None
        self._readers: ThreadPoolExecutor | None = None
        # What surrounds each operation, by its name.
        self.measure: Callable[[str], AbstractContextManager[None]] = lambda _: nullcontext()

    @classmethod
    def open(cls, url: str) -> "AttemptStore":
        """The store at a URL or in an SQLite file. Raises UnusableDatabaseError."""
        engine = open_database(url)
        try:
            with engine.begin() as connection:
                connection.execute(_ALIVE)
        except SQLAlchemyError as error:
            problem = f"{safe_url(engine)}: attempts cannot be recorded there: {reason(error)}"
            raise UnusableDatabaseError(problem) from error
        finally:
            # No connection may be carried into processes that are started later.
            engine.dispose()
        return cls(engine)

    def start(self) -> None:
        """Begin to take attempts, in the process that serves."""
        self._writer = AttemptWriter(self.engine, lambda: finish_overwriting(self.engine))
        self._readers = ThreadPoolExecutor(_READERS, "attempts-read")

    def close(self) -> None:
        """Write what waits, and end."""
        if self._writer is not None:
            self._writer.close()
            self._writer = None
        if self._readers is not None:
            self._readers.shutdown()
            self._readers = None
        self.engine.dispose()

    async def standing(
        self, exercise: str, learner: str, owner: str, idempotency_key: str | None
    ) -> Standing:
        """How a learner stands at an exercise, and what a request with this key has recorded."""
        with self.measure("standing"):
            return await self._running.run(
                lambda connection: standing(connection, exercise, learner, owner, idempotency_key)
            )

    async def record(
        self, before: Standing, attempt_after: AttemptAfter
    ) -> RecordedAttempt | Standing:
        """Write the attempt that a standing allows, durably; see ``record_next``.

        ``attempt_after`` is called in the thread that writes, while others wait for it.
        """
        with self.measure("record"):
            return await self._running.run(
                lambda connection: record_next(connection, before, attempt_after)
            )

    async def check(self) -> None:
        """Make sure that the database answers."""
        with self.measure("check"):
            await self._running.run(lambda connection: connection.execute(_ALIVE))

    async def page(
        self, wanted: AttemptFilter, cursor: str | None, most: int
    ) -> tuple[list[ListedAttempt], str | None]:
        """At most ``most`` attempts, the newest first, and the cursor of the next page if any.

        Raises BadCursorError.
        """
        return await self._read(lambda connection: page(connection, wanted, cursor, most))

    async def history(self, attempt_id: str) -> AttemptHistory | None:
        """An attempt with its answers, reports and overrides; None where there is none."""
        return await self._read(lambda connection: history(connection, attempt_id))

    async def statistics(self, wanted: AttemptFilter) -> ExerciseStatistics:
        """The statistics of the attempts at ``wanted.exercise`` in a span of time."""
        return await self._read(lambda connection: exercise_statistics(connection, wanted))

    async def export(
        self,
        wanted: AttemptFilter,
        form: GradesFormat,
        title: str,
        counting: Callable[[str], Counting],
    ) -> IO[bytes]:
        """The attempts in a format, as a file that the caller closes; see ``written``."""
        return await self._read(
            lambda connection: _file_of(
                written(graded_attempts(connection, wanted, counting), form, title)
            )
        )

    async def override(
        self, attempt_id: str, points: float | None, reason_given: str, author: str
    ) -> ListedAttempt:
        """The attempt with these points in place of its report's; None withdraws earlier ones.

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
        """How much is recorded of a learner."""
        return await self._read(lambda connection: data_of(connection, learner))

    async def forget(self, learner: str) -> tuple[LearnerData, bool | None]:
        """Delete all that is recorded of a learner; return how much it was.

        With it, whether it is overwritten by now; see ``overwrite_deleted``. If not, the thread
        that writes tries again every minute.
        """
        with self.measure("forget"):
            deleted = await self._running.run(lambda connection: forget(connection, learner))
            try:
                erased = await asyncio.to_thread(overwrite_deleted, self.engine)
            except SQLAlchemyError:
                # It is deleted all the same.
                erased = False
        return deleted, erased

    async def _read(self, work: Callable[[Connection], R]) -> R:
        """The result of ``work``, which writes nothing; beside the attempts that are recorded."""
        assert self._readers is not None, "the store has not been started"
        loop = asyncio.get_running_loop()
        with self.measure("read"):
            found = loop.run_in_executor(self._readers, self._read_by, work)
            try:
                return await asyncio.wait_for(found, _READING)
            except TimeoutError as error:
                raise StoreDownError(f"the database has not answered for {_READING:g} s") from error

    def _read_by(self, work: Callable[[Connection], R]) -> R:
        try:
            with self.engine.connect() as connection:
                return work(connection)
        except SQLAlchemyError as error:
            raise StoreDownError(reason(error)) from error

    @property
    def _running(self) -> AttemptWriter:
        assert self._writer is not None, "the store has not been started"
        return self._writer


def _file_of(lines: Iterable[bytes]) -> IO[bytes]:
    """Lines as a file that is read from its beginning.

    So the database is done with them, however slowly they are then read.
    """
    file = tempfile.SpooledTemporaryFile(_IN_MEMORY)  # noqa: SIM115 - the caller closes it
    try:
        file.writelines(lines)
    except BaseException:
        file.close()
        raise
    file.seek(0)
    return file
