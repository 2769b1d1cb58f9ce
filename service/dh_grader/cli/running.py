"""Grade many submissions at once: in threads, in processes, or in shards on several machines."""

import hashlib
import json
import os
import re
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass
from functools import partial
from itertools import chain, islice
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any, BinaryIO, Final, TypeVar, cast

import typer

from dh_grader.regex import regex
from dh_grader.translations import reason_of, say

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.pool import AsyncResult


Item = TypeVar("Item")
Result = TypeVar("Result")


# --- Map a function over items in several processes; the results keep the order of the items


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
    function: Callable[[Item], Result], items: Sequence[Item], jobs: int
) -> Iterator[Iterator[Result]]:
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


# --- Map a function that waits for I/O over many items in several threads


@contextmanager
def mapped_in_threads(
    function: Callable[[Item], Result], items: Iterable[Item], jobs: int
) -> Iterator[Iterator[Result]]:
    """Yield an iterator over the results in the order of the items.

    At the end of the context, no further call starts, and nothing waits for running calls.
    """
    # Import here: most runs need no threads. ThreadPoolExecutor would delay the end of the program
    # until its threads end; the threads of this pool are daemons.
    from multiprocessing.pool import ThreadPool

    with ThreadPool(jobs) as pool:
        yield _in_order((pool.apply_async(function, (item,)) for item in items), 2 * jobs)


def _in_order(begun: Iterator["AsyncResult[Result]"], ahead: int) -> Iterator[Result]:
    waiting = deque(islice(begun, ahead))
    while waiting:
        yield waiting.popleft().get()
        waiting.extend(islice(begun, 1))


# --- Divide the submissions of a class between machines, and merge the results
#
# Shard 3 of 16 has the submissions 3, 19, 35, and so on. The first line of a shard's file is a
# header that describes the division, so that merging notices a missing, incomplete or foreign file.


MOST_SHARDS: Final = 1000
# The longest header; a file of something else may have lines of any length.
_LONGEST_HEADER: Final = 1000
_FORM: Final = regex(r"([0-9]{1,4})/([0-9]{1,4})", re.ASCII)


class UnusableShardsError(ValueError):
    """The files are not all shards (parts) of the same run; the message says why."""


@dataclass(frozen=True, slots=True)
class Shard:
    """A shard: one of ``count`` subsets of the submissions, numbered from 1."""

    number: int
    count: int

    def of(self, items: Sequence[Item]) -> list[Item]:
        """Return the items that belong to this shard."""
        return list(items[self.number - 1 :: self.count])


def shard_of(text: str) -> Shard:
    """Parse a shard such as ``3/16``, the third of 16 subsets of the submissions.

    Raises typer.BadParameter.
    """
    found = _FORM.fullmatch(text)
    shard = Shard(int(found[1]), int(found[2])) if found else Shard(0, 0)
    if not 1 <= shard.number <= shard.count <= MOST_SHARDS:
        raise typer.BadParameter(
            f"{text!r} is not a shard such as 3/16: a number from 1 to the count of shards, which "
            f"is at most {MOST_SHARDS}."
        )
    return shard


@dataclass(frozen=True, slots=True)
class ShardHeader:
    """The first line of a file with the results of one shard (subset of the submissions).

    ``exercises`` is the number of lines for each submission. ``run`` is a hash of the names of all
    submissions and exercises.
    """

    shard: int
    shards: int
    submissions: int
    exercises: int
    run: str


def with_header(
    lines: Iterable[bytes], shard: Shard, submissions: Sequence[str], exercises: Sequence[str]
) -> Iterator[bytes]:
    """Yield the header of a shard's file, then the lines.

    ``submissions`` and ``exercises`` are all names in the run, not only in this shard.
    """
    names = json.dumps([submissions, exercises])
    run = hashlib.sha256(names.encode()).hexdigest()
    header = ShardHeader(shard.number, shard.count, len(submissions), len(exercises), run)
    yield json.dumps(asdict(header)).encode() + b"\n"
    yield from lines


def merged(files: Sequence[Path]) -> Iterator[bytes]:
    """Yield the lines of a whole run from the files of its shards.

    Raises UnusableShardsError.
    """
    with ExitStack() as opened:
        shards: dict[int, tuple[ShardHeader, Path, BinaryIO]] = {}
        for path in files:
            file = opened.enter_context(_opened(path))
            header = _header(file.readline(_LONGEST_HEADER), path)
            if header.shard in shards:
                raise UnusableShardsError(
                    say(
                        "{path} is shard {shard}, and so is {other}",
                        path=str(path),
                        shard=header.shard,
                        other=str(shards[header.shard][1]),
                    )
                )
            shards[header.shard] = header, path, file
        _require_one_run(shards)
        in_order = [shards[number] for number in sorted(shards)]
        first = in_order[0][0]
        for i in range(first.submissions):
            _, path, file = in_order[i % first.shards]
            yield from islice(_whole_lines(file, path), first.exercises)
        for _, path, file in in_order:
            if file.read(1):
                raise UnusableShardsError(
                    say("{path} has more lines than its header says", path=str(path))
                )


def _opened(path: Path) -> BinaryIO:
    try:
        return path.open("rb")
    except OSError as error:
        raise UnusableShardsError(
            say("{path} cannot be read: {reason}", path=str(path), reason=reason_of(error))
        ) from error


def _header(line: bytes, path: Path) -> ShardHeader:
    try:
        header = ShardHeader(**json.loads(line))
        shard_of(f"{header.shard}/{header.shards}")
    except (ValueError, TypeError, typer.BadParameter):
        raise UnusableShardsError(
            say("{path} is not a shard; dh-grader grade --shard writes shards", path=str(path))
        ) from None
    return header


def _require_one_run(shards: dict[int, tuple[ShardHeader, Path, BinaryIO]]) -> None:
    first, first_path, _ = next(iter(shards.values()))
    for header, path, _ in shards.values():
        same = (header.shards, header.submissions, header.exercises, header.run)
        if same != (first.shards, first.submissions, first.exercises, first.run):
            raise UnusableShardsError(
                say(
                    "{path} is from another run than {first_path}: the submissions, the "
                    "assignment or the count of shards differ",
                    path=str(path),
                    first_path=str(first_path),
                )
            )
    missing = [number for number in range(1, first.shards + 1) if number not in shards]
    if missing:
        numbers = ", ".join(map(str, missing))
        raise UnusableShardsError(
            say("Missing shards of {count}: {numbers}.", count=first.shards, numbers=numbers)
        )


def _whole_lines(file: BinaryIO, path: Path) -> Iterator[bytes]:
    while True:
        line = file.readline()
        if not line.endswith(b"\n"):
            raise UnusableShardsError(
                say("{path} is incomplete; grade this shard again", path=str(path))
            )
        yield line
