"""One function over many things in several processes: in order, and with few of them in memory."""

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from itertools import islice
from typing import TYPE_CHECKING, Any, Final, TypeVar, cast

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")

# Large enough that handing over costs little, small enough that no process waits long for another.
_CHUNK: Final = 8
# A process takes half a second to start, in which one alone grades a hundred submissions.
_WORTH_A_PROCESS: Final = 100
_FOR_THE_GROUP: Final = (signal.SIGINT, signal.SIGTERM)


class WorkerLostError(Exception):
    """A process did not start, or ended before its work was done: it was killed, say."""


def jobs_for(count: int) -> int:
    """How many processes are worth their start for so many submissions."""
    if hasattr(os, "sched_getaffinity"):
        cores = len(os.sched_getaffinity(0))
    else:
        cores = os.cpu_count() or 1
    return max(1, min(cores, count // _WORTH_A_PROCESS))


@contextmanager
def mapped(
    function: Callable[[_Item], _Result], items: Sequence[_Item], jobs: int
) -> Iterator[Iterator[_Result]]:
    """The results in the order of the items, worked out as they are asked for.

    With one job all is done in this process. The others end with the context, whatever they are
    at. ``function`` and the items are pickled. Raises WorkerLostError while iterated.
    """
    if jobs == 1:
        yield map(function, items)
        return
    with _workers(function, jobs) as workers:
        yield _in_order(workers, items)


def _in_order(workers: Sequence["Connection"], items: Sequence[_Item]) -> Iterator[Any]:
    """The results of chunks that the workers are given whenever they have none."""
    from multiprocessing.connection import wait

    chunks = (items[i : i + _CHUNK] for i in range(0, len(items), _CHUNK))
    numbered = enumerate(chunks)
    idle, busy = list(workers), dict["Connection", int]()
    done: dict[int, list[Any]] = {}
    following = 0
    while True:
        # As much is done ahead as waits in memory: a slow chunk holds the others up.
        ahead = 2 * len(workers) - len(busy) - len(done)
        for i, chunk in islice(numbered, max(0, min(len(idle), ahead))):
            worker = idle.pop()
            _send(worker, chunk)
            busy[worker] = i
        if not busy and not done:
            return
        for worker in cast("list[Connection]", wait(list(busy))):
            done[busy.pop(worker)] = _received(worker)
            idle.append(worker)
        while following in done:
            yield from done.pop(following)
            following += 1


def _send(worker: "Connection", chunk: Sequence[Any]) -> None:
    try:
        worker.send(chunk)
    except OSError as error:
        raise WorkerLostError from error


def _received(worker: "Connection") -> list[Any]:
    try:
        return cast("list[Any]", worker.recv())
    except (EOFError, OSError) as error:
        raise WorkerLostError from error


@contextmanager
def _workers(function: Callable[[Any], Any], jobs: int) -> Iterator[list["Connection"]]:
    """Processes that apply the function, by what leads to each. They end with the context."""
    # Only here: one process needs none of it.
    from multiprocessing import get_context, resource_tracker

    # A fork of a process with threads, as numpy has, may hang.
    context = get_context("spawn")
    if os.name == "posix":
        # The first process would start it, and let signals through again in its own start.
        resource_tracker.ensure_running()
    processes, connections = [], []
    try:
        for _ in range(jobs):
            ours, theirs = context.Pipe()
            connections.append(ours)
            process = context.Process(target=_work, args=(theirs, function), daemon=True)
            try:
                with _unreached():
                    process.start()
            except OSError as error:
                raise WorkerLostError from error
            processes.append(process)
            # Where this process ends, however it does, the other then finds the pipe closed.
            theirs.close()
        yield connections
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.join()
        for connection in connections:
            connection.close()


@contextmanager
def _unreached() -> Iterator[None]:
    """Start processes that no signal to the whole group ends, as Ctrl-C sends one.

    This process ends them; if they ended first, it would take that for the fault.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _FOR_THE_GROUP)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(connection: "Connection", function: Callable[[Any], Any]) -> None:
    """Apply the function to one chunk after the other."""
    for number in _FOR_THE_GROUP:
        signal.signal(number, signal.SIG_IGN)
    # Where the other end is closed, nobody waits for results.
    with suppress(EOFError, OSError):
        while True:
            chunk = connection.recv()
            connection.send([function(item) for item in chunk])
