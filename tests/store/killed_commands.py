"""Run commands of `dh-grader` in processes that are killed."""

import os
import random
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any, Final

from dh_grader.cli import program
from dh_grader.store import database as database_file
from sqlalchemy import Engine, event

from tests.guards import ANSWER

# The events of Python's audit hooks that stand for a step on the disk.
_ON_DISK: Final = ("open", "os.link", "os.remove", "os.rename", "sqlite3.connect")


def _command(url: str, words: Sequence[str], told: Connection, killed_at: int) -> None:
    # Run a command. Kill this process before the step ``killed_at``: a step on the files of a
    # database, a statement or a commit.
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    os.environ["DH_GRADER_DATABASE"] = url
    steps = 0

    def step(*_: object) -> None:
        nonlocal steps
        steps += 1
        if steps == killed_at:
            os.kill(os.getpid(), signal.SIGKILL)

    def audited(name: str, args: tuple[Any, ...]) -> None:
        if name in _ON_DISK and any(".db" in str(each) for each in args[:2]):
            step()

    flush = database_file._flush

    def flushed(path: Any) -> None:
        step()
        flush(path)

    database_file._flush = flushed
    sys.addaudithook(audited)
    event.listen(Engine, "before_cursor_execute", step)
    event.listen(Engine, "commit", step)
    told.send("begun")
    try:
        program(list(words), prog_name="dh-grader")
    finally:
        told.send(steps)


@dataclass(frozen=True, slots=True)
class Ended:
    """The exit code of a command (-9 if it was killed), its seconds, and its number of steps."""

    code: int
    seconds: float
    steps: int


def command(
    killable: Any, url: str, *words: object, after: float | None = None, before_step: int = 0
) -> Ended:
    """Run a command, and kill it after some seconds or before a step, if one of them is given."""
    told, telling = Pipe(duplex=False)
    args = (url, [str(word) for word in words], telling, before_step)
    process = killable(target=_command, args=args)
    process.start()
    telling.close()
    assert told.recv() == "begun"
    begun, steps = time.monotonic(), 0
    if after is not None:
        process.join(after)
        process.kill()
    process.join(ANSWER)
    seconds = time.monotonic() - begun
    with suppress(EOFError):
        steps = told.recv()
    told.close()
    return Ended(process.exitcode, seconds, steps)


def kills(count: int, whole: Ended, seed: object) -> Iterator[dict[str, Any]]:
    """Return arguments that kill a command at as many moments: after seconds, and before steps."""
    by_clock = (count + 1) // 2
    for moment in moments(by_clock, whole.seconds, seed):
        yield {"after": moment}
    dice = random.Random(str(seed))
    for i in range(count - by_clock):
        yield {"before_step": 1 + int((i + dice.random()) / (count - by_clock) * whole.steps)}


def moments(count: int, seconds: float, seed: object) -> Iterator[float]:
    """Return as many moments, one in each of the equal parts of a command's seconds."""
    dice = random.Random(str(seed))
    for i in range(count):
        yield (i + dice.random()) / count * seconds
