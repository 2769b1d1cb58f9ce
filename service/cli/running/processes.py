"""Map a function over items in several processes; the results keep the order of the items."""

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from itertools import chain
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any, Final, TypeVar, cast

from service.cli.running.threads import mapped_in_threads

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")

# Large enough that passing a chunk costs little, small enough that no process waits long.
_CHUNK: Final = 8
# A process takes half a second to start; in that time another one grades a hundred submissions.
_WORTH_A_PROCESS: Final = 100
_GROUP_SIGNALS: Final = (signal.SIGINT, signal.SIGTERM)


class WorkerLostError(Exception):
    """A worker process did not start, or ended too early."""


def jobs_for(count: int) -> int:
    """Return the best number of processes for ``count`` submissions."""
    if hasattr(os, "sched_getaffinity"):
        cores = len(os.sched_getaffinity(0))
    else:
        cores = os.cpu_count() or 1
    return max(1, min(cores, count // _WORTH_A_PROCESS))


@contextmanager
def mapped(
    function: Callable[[_Item], _Result], items: Sequence[_Item], jobs: int
) -> Iterator[Iterator[_Result]]:
    """Yield an iterator over the results in the order of the items.

    With several ``jobs``, ``function`` and the items are pickled. Iteration raises WorkerLostError.
    """
    if jobs == 1:
        yield map(function, items)
        return
    chunks = (items[i : i + _CHUNK] for i in range(0, len(items), _CHUNK))
    with (
        _workers(function, jobs) as workers,
        mapped_in_threads(partial(_results, workers), chunks, jobs) as results,
    ):
        yield chain.from_iterable(results)


def _results(idle: "SimpleQueue[Connection]", chunk: Sequence[Any]) -> list[Any]:
    worker = idle.get()
    try:
        worker.send(chunk)
        return cast("list[Any]", worker.recv())
    except (EOFError, OSError) as error:
        raise WorkerLostError from error
    finally:
        idle.put(worker)


@contextmanager
def _workers(function: Callable[[Any], Any], jobs: int) -> Iterator["SimpleQueue[Connection]"]:
    # Import here: a single process needs none of this.
    from multiprocessing import get_context, resource_tracker

    # Do not fork: a forked process with threads, like those of numpy, may hang.
    context = get_context("spawn")
    if os.name == "posix":
        # Otherwise the first process would start it, and unblock the signals while doing so.
        resource_tracker.ensure_running()
    processes = []
    # Not closed here: a thread may still read. The last reference closes it.
    connections: SimpleQueue[Connection] = SimpleQueue()
    try:
        for _ in range(jobs):
            ours, theirs = context.Pipe()
            connections.put(ours)
            process = context.Process(target=_work, args=(theirs, function), daemon=True)
            try:
                with _signals_blocked():
                    process.start()
            except OSError as error:
                raise WorkerLostError from error
            processes.append(process)
            # With our copy closed, the worker sees the end of this process as a closed pipe.
            theirs.close()
        yield connections
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.join()


@contextmanager
def _signals_blocked() -> Iterator[None]:
    # This process itself ends its workers. If a signal such as Ctrl-C ended a worker first, this
    # process would report the worker as lost.
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _GROUP_SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(connection: "Connection", function: Callable[[Any], Any]) -> None:
    for number in _GROUP_SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    # If the other end is closed, nobody waits for results.
    with suppress(EOFError, OSError):
        while True:
            chunk = connection.recv()
            connection.send([function(item) for item in chunk])
