"""`python -m tests.attack.memory --count 1000000`: test if many requests make the memory grow.

With ``--http``, send the requests to a separate process. Exit with 1 if the memory grows too much,
or if a response is a server error.
"""

import argparse
import gc
import http.client
import json
import os
import re
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from random import Random
from typing import Final

from tests.attack import bodies
from tests.attack.in_process import InProcess, Post
from tests.benchmarks.answers import T06, distinct, one_student_s_table, table
from tests.guards import ANSWER
from tests.server.raw import service

# The number of requests after which all caches are full: the largest keeps 8,192 texts.
WARM_UP: Final = 20_000
# The growth in MB that is allowed, because the allocator fragments the memory.
FLAT: Final = 20.0
PROGRESS_SECONDS: Final = 20.0
_STANFORD: Final = "/v1/exercises/stanford-arm/grade"

Send = Callable[[Post], int]


def posts(seed: str) -> Iterator[Post]:
    """Yield random requests without end, all different."""
    number = 0
    while True:
        number += 1
        random = Random(f"{seed}.{number}")
        kind = random.random()
        if kind < 0.45:
            yield _student_s_table(random, number)
        elif kind < 0.55:
            yield _matrix(random, number)
        elif kind < 0.97:
            yield _preview(random, number)
        elif kind < 0.99:
            yield bodies.submission(random, number)
        else:
            yield bodies.preview(random, number)


def _student_s_table(random: Random, number: int) -> Post:
    rows = [list(row) for row in one_student_s_table(number)]
    at = random.randrange(6)
    rows[at][0] = f"{rows[at][0]} + 0*{number}"
    return _graded({"table": table([tuple(row) for row in rows])})  # type: ignore[misc]


def _matrix(random: Random, number: int) -> Post:
    pose = distinct(T06, number)
    if random.random() < 0.25:
        pose[random.randrange(3)][random.randrange(4)] += " + s1"
    return _graded({"pose": pose})


def _preview(random: Random, number: int) -> Post:
    text = f"{random.choice(random.choice(T06))} + {number}*d2"
    body = {"text": text, "exercise": "stanford-arm", "part": "pose"}
    return Post(bodies.PREVIEW, json.dumps(body).encode())


def _graded(answers: dict[str, object]) -> Post:
    return Post(_STANFORD, json.dumps({"answers": answers}).encode())


def resident(process: int | None = None) -> float:
    """Return the memory of a process in MB, or nan if unknown."""
    status = Path(f"/proc/{process or os.getpid()}/status")
    found = status.is_file() and re.search(r"VmRSS:\s+(\d+)", status.read_text(encoding="ascii"))
    return int(found[1]) / 1024 if found else float("nan")


@dataclass
class MemoryUse:
    """The memory (MB) after the warm-up and at the end, and the number of server errors."""

    count: int
    warm: float
    end: float
    failures: int

    @property
    def growth(self) -> float:
        return self.end - self.warm

    def __str__(self) -> str:
        return (
            f"{self.count:,} requests: {self.warm:.1f} MB after the warm-up, {self.end:.1f} MB at "
            f"the end, {self.growth:+.1f} MB; {self.failures} failures"
        )


@contextmanager
def in_process() -> Iterator[tuple[Send, Callable[[], float]]]:
    with closing(InProcess()) as running:
        # The server does this when it starts.
        gc.collect()
        gc.freeze()
        try:
            yield lambda post: running.post(post).status, resident
        finally:
            gc.unfreeze()


@contextmanager
def over_http() -> Iterator[tuple[Send, Callable[[], float]]]:
    with tempfile.TemporaryDirectory() as folder, service(Path(folder)) as running:
        connection = http.client.HTTPConnection("127.0.0.1", running.port, timeout=ANSWER)

        def send(post: Post) -> int:
            connection.request("POST", post.path, post.body, {"Content-Type": "application/json"})
            answer = connection.getresponse()
            answer.read()
            return answer.status

        with closing(connection):
            yield send, lambda: resident(running.process.pid)


def measured(
    count: int,
    warm_up: int,
    seed: str,
    way: Callable[[], object] = in_process,
    minutes: float = float("inf"),
) -> MemoryUse:
    with way() as (send, memory):  # type: ignore[attr-defined]
        endless = posts(seed)
        failures = sum(send(post) >= 500 for post in islice(endless, warm_up))
        gc.collect()
        warm = memory()
        reported = began = time.monotonic()
        sent = 0
        for post in islice(endless, count):
            failures += send(post) >= 500
            sent += 1
            now = time.monotonic()
            if now - reported > PROGRESS_SECONDS:
                reported = now
                sys.stderr.write(f"{sent:,} of {count:,}: {memory():.1f} MB, began at {warm:.1f}\n")
            if now - began > 60 * minutes:
                break
        gc.collect()
        return MemoryUse(warm_up + sent, warm, memory(), failures)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000, help="requests after the warm-up")
    parser.add_argument("--warm-up", type=int, default=WARM_UP)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--http", action="store_true", help="use a separate process")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="stop after this time")
    options = parser.parse_args(arguments)
    way = over_http if options.http else in_process
    found = measured(options.count, options.warm_up, options.seed, way, options.minutes)
    sys.stdout.write(f"{found}\n")
    return int(found.failures > 0 or found.growth > FLAT)


if __name__ == "__main__":
    raise SystemExit(main())
