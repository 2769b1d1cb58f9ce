"""The thread that writes to the database, and commits several waiting attempts at once."""

import asyncio
import logging
import queue
import threading
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from math import inf
from time import monotonic, sleep
from typing import Any, Final, TypeVar

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from service.attempts.errors import StoreDownError
from service.attempts.storage.database import is_deadlock, reason

R = TypeVar("R")

_log = logging.getLogger(__name__)

_SILENT: Final = "the database does not react"

# The most jobs in one transaction, and in the queue before further jobs are refused.
_MAX_TOGETHER: Final = 64
_MAX_WAITING: Final = 4096
# The time until the next call of ``tidy`` after one that failed (seconds).
_TIDY_AGAIN: Final = 60.0
# How long a job waits for the database in all (seconds). A paused server raises no error, and
# waiting for a lock takes up to five seconds.
_TIMEOUT: Final = 15.0
# How long the first of several concurrent jobs waits for others (seconds): a commit for each would
# cost twice the processor time. A client that sends one attempt after the other never waits.
_GATHER: Final = 0.01


@dataclass(frozen=True, slots=True)
class _Job:
    work: Callable[[Connection], Any]
    loop: asyncio.AbstractEventLoop
    done: "asyncio.Future[Any]"


# A job with its result or its exception.
_Finished = tuple[_Job, Any, Exception | None]


class AttemptWriter:
    """Runs jobs (functions that write) in order, many jobs in one transaction.

    A job gets its result only after the commit. A failing job does not affect others.
    """

    def __init__(self, engine: Engine, tidy: Callable[[], float] = lambda: 3600.0) -> None:
        """Start the thread, which calls ``tidy``, and again after the seconds that it returns."""
        self._engine = engine
        self._tidy = tidy
        self._tidy_at = monotonic()
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        # The start of the current transaction; None while the thread is idle.
        self._begun_at: float | None = None
        # The time of the last job that the database failed or refused, or that waited too long.
        self.failed_at = -inf
        self._thread = threading.Thread(target=self._run, name="attempts", daemon=True)
        self._thread.start()

    async def run(self, work: Callable[[Connection], R]) -> R:
        """Return the result of ``work`` after its commit. Raises StoreDownError."""
        begun_at = self._begun_at
        if begun_at is not None and monotonic() - begun_at > _TIMEOUT:
            raise self._failed(_SILENT)
        if self._jobs.qsize() >= _MAX_WAITING:
            raise self._failed("too many attempts wait to be written")
        loop = asyncio.get_running_loop()
        job = _Job(work, loop, loop.create_future())
        self._jobs.put(job)
        try:
            async with asyncio.timeout(_TIMEOUT):
                result: R = await job.done
        except TimeoutError as error:
            raise self._failed(_SILENT) from error
        return result

    def _failed(self, why: str) -> StoreDownError:
        self.failed_at = monotonic()
        return StoreDownError(why)

    def close(self) -> None:
        """Flush pending jobs and stop the writer thread."""
        self._jobs.put(None)
        self._thread.join()

    def _run(self) -> None:
        ended = is_busy = False
        while not ended:
            jobs, ended = self._waiting(_GATHER if is_busy else 0)
            # Skip jobs whose caller has gone.
            jobs = [job for job in jobs if not job.done.cancelled()]
            if jobs:
                self._process(jobs)
                self._begun_at = None
                is_busy = len(jobs) > 1
            if monotonic() >= self._tidy_at and not ended:
                pause = _TIDY_AGAIN
                try:
                    pause = self._tidy()
                except Exception:  # noqa: BLE001 - recording must go on
                    _log.exception("The database could not be tidied up")
                self._tidy_at = monotonic() + pause

    def _waiting(self, gather: float) -> tuple[list[_Job], bool]:
        jobs: list[_Job] = []
        try:
            found = self._jobs.get(timeout=max(0.0, self._tidy_at - monotonic()))
        except queue.Empty:
            return jobs, False
        if gather and found is not None:
            sleep(gather)
        while found is not None:
            jobs.append(found)
            if len(jobs) == _MAX_TOGETHER:
                return jobs, False
            try:
                found = self._jobs.get_nowait()
            except queue.Empty:
                return jobs, False
        return jobs, True

    def _process(self, jobs: list[_Job]) -> None:
        self._begun_at = monotonic()
        try:
            results = self._run_together(jobs)
        except Exception as error:  # noqa: BLE001 - each job gets its own exception
            if len(jobs) > 1 and not is_database_failure(error):
                for job in jobs:
                    self._process([job])
                return
            failure = _as_store_error(error)
            if isinstance(failure, StoreDownError):
                self.failed_at = monotonic()
            _deliver([(job, None, failure) for job in jobs])
            return
        _deliver([(job, result, None) for job, result in zip(jobs, results, strict=True)])

    def _run_together(self, jobs: list[_Job]) -> list[Any]:
        with self._engine.connect() as connection:
            connection = connection.execution_options(writes=True)
            with connection.begin():
                return [job.work(connection) for job in jobs]


def _deliver(finished: list[_Finished]) -> None:
    by_loop: dict[asyncio.AbstractEventLoop, list[_Finished]] = defaultdict(list)
    for each in finished:
        by_loop[each[0].loop].append(each)
    for loop, jobs in by_loop.items():
        # A closed loop has no callers.
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(_resolve, jobs)


def _resolve(finished: list[_Finished]) -> None:
    for job, result, failure in finished:
        if job.done.done():
            continue
        if failure is None:
            job.done.set_result(result)
        else:
            job.done.set_exception(failure)


def is_database_failure(error: Exception) -> bool:
    """True if the database itself failed, so that an immediate retry would fail, too."""
    # Transactions of several attempts may deadlock; run one by one, they do not.
    if is_deadlock(error):
        return False
    return isinstance(error, SQLAlchemyError) and (
        not isinstance(error, DBAPIError)
        or error.connection_invalidated
        or type(error).__name__ in ("OperationalError", "InternalError", "InterfaceError")
    )


def _as_store_error(error: Exception) -> Exception:
    return StoreDownError(reason(error)) if isinstance(error, SQLAlchemyError) else error
