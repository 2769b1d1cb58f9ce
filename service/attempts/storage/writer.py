"""One thread that writes: what waits is written together, so that many share one durable commit."""

import asyncio
import logging
import queue
import threading
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from time import monotonic, sleep
from typing import Any, Final, TypeVar

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from service.attempts.errors import StoreDownError
from service.attempts.storage.database import is_deadlock, reason

R = TypeVar("R")

_log = logging.getLogger(__name__)

_SILENT: Final = "the database does not react"

# So many share a transaction at the most, and so many wait before others are turned away.
_TOGETHER: Final = 64
_WAITING: Final = 4096
# Seconds between two times at which the thread tidies up; the first is at its start.
_TIDYING: Final = 60.0
# How long a job waits for the database in all (seconds). A server that does not react at all (a
# machine that is paused) raises no error, and a lock is waited for five seconds.
_PATIENCE: Final = 15.0
# Where jobs come at once, the first one waits so long for others (seconds): a commit for each costs
# twice the processor time. A client that sends one attempt after the other never waits.
_GATHER: Final = 0.01


@dataclass(frozen=True, slots=True)
class _Job:
    work: Callable[[Connection], Any]
    loop: asyncio.AbstractEventLoop
    done: "asyncio.Future[Any]"


# A job and its result, or the failure that it is told of.
_Settled = tuple[_Job, Any, Exception | None]


class AttemptWriter:
    """Runs functions on a connection, in the order in which they come; many in one transaction.

    A result is given only after the commit: what it says is durable. Where the transaction of
    several fails, each gets one of its own, so that one that cannot be written costs no other.
    """

    def __init__(self, engine: Engine, tidy: Callable[[], None] = lambda: None) -> None:
        """Start the thread; it calls ``tidy`` at its start and then every minute."""
        self._engine = engine
        self._tidy = tidy
        self._tidy_at = monotonic()
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        # When the thread last began to ask the database, while it waits for the answer.
        self._asked_at: float | None = None
        self._thread = threading.Thread(target=self._run, name="attempts", daemon=True)
        self._thread.start()

    async def run(self, work: Callable[[Connection], R]) -> R:
        """The result of ``work``, committed. Raises StoreDownError if the database did not say so.

        Usually nothing was written then; but a commit whose answer is lost may have taken effect.
        """
        asked_at = self._asked_at
        if asked_at is not None and monotonic() - asked_at > _PATIENCE:
            raise StoreDownError(_SILENT)
        if self._jobs.qsize() >= _WAITING:
            raise StoreDownError("too many attempts wait to be written")
        loop = asyncio.get_running_loop()
        job = _Job(work, loop, loop.create_future())
        self._jobs.put(job)
        try:
            async with asyncio.timeout(_PATIENCE):
                result: R = await job.done
        except TimeoutError as error:
            raise StoreDownError(_SILENT) from error
        return result

    def close(self) -> None:
        """Write what waits, and end."""
        self._jobs.put(None)
        self._thread.join()

    def _run(self) -> None:
        ended = is_busy = False
        while not ended:
            jobs, ended = self._waiting(_GATHER if is_busy else 0)
            # Who has gone away needs no answer, and what nobody waits for is not begun.
            jobs = [job for job in jobs if not job.done.cancelled()]
            if jobs:
                self._work_off(jobs)
                self._asked_at = None
                is_busy = len(jobs) > 1
            if monotonic() >= self._tidy_at and not ended:
                try:
                    self._tidy()
                except Exception:  # noqa: BLE001 - attempts are recorded all the same
                    _log.exception("The database could not be tidied up")
                self._tidy_at = monotonic() + _TIDYING

    def _waiting(self, gather: float) -> tuple[list[_Job], bool]:
        """The jobs that wait, none if it is time to tidy up, and whether the end has come.

        After the first job, wait ``gather`` seconds for others.
        """
        jobs: list[_Job] = []
        try:
            found = self._jobs.get(timeout=max(0.0, self._tidy_at - monotonic()))
        except queue.Empty:
            return jobs, False
        if gather and found is not None:
            sleep(gather)
        while found is not None:
            jobs.append(found)
            if len(jobs) == _TOGETHER:
                return jobs, False
            try:
                found = self._jobs.get_nowait()
            except queue.Empty:
                return jobs, False
        return jobs, True

    def _work_off(self, jobs: list[_Job]) -> None:
        self._asked_at = monotonic()
        try:
            results = self._together(jobs)
        except Exception as error:  # noqa: BLE001 - each job is told of its own failure
            if len(jobs) > 1 and not is_lost(error):
                for job in jobs:
                    self._work_off([job])
                return
            failure = _told(error)
            _settle([(job, None, failure) for job in jobs])
            return
        _settle([(job, result, None) for job, result in zip(jobs, results, strict=True)])

    def _together(self, jobs: list[_Job]) -> list[Any]:
        with self._engine.connect() as connection:
            connection = connection.execution_options(writes=True)
            with connection.begin():
                return [job.work(connection) for job in jobs]


def _settle(settled: list[_Settled]) -> None:
    """Tell those who wait, all of a loop by waking it once."""
    by_loop: dict[asyncio.AbstractEventLoop, list[_Settled]] = defaultdict(list)
    for each in settled:
        by_loop[each[0].loop].append(each)
    for loop, those in by_loop.items():
        # Nobody waits in a loop that is closed.
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(_tell, those)


def _tell(settled: list[_Settled]) -> None:
    for job, result, failure in settled:
        if job.done.done():
            continue
        if failure is None:
            job.done.set_result(result)
        else:
            job.done.set_exception(failure)


def is_lost(error: Exception) -> bool:
    """Whether the database itself failed, so that another try at once would fail as well."""
    # Two transactions of several attempts each may wait for one another; those of one each do not.
    if is_deadlock(error):
        return False
    return isinstance(error, SQLAlchemyError) and (
        not isinstance(error, DBAPIError)
        or error.connection_invalidated
        or type(error).__name__ in ("OperationalError", "InternalError", "InterfaceError")
    )


def _told(error: Exception) -> Exception:
    return StoreDownError(reason(error)) if isinstance(error, SQLAlchemyError) else error
