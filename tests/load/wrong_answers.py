"""`python -m tests.load.wrong_answers`: measure the service with mostly wrong answers.

Exit with 1 if the service is slower than promised. Run nothing else meanwhile.
"""

# A course server sends tables with slips over eight connections from one address, then 120 students
# submit in the same instant. Compare both with grading the same tables in this process.

import argparse
import asyncio
import http.client
import json
import random
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from dh_grader.api.http import validated
from dh_grader.catalogue import Exercise
from dh_grader.grading import grade
from dh_grader.submissions.bodies import GradeRequest

from tests.guards import ANSWER
from tests.server.raw import Service, service
from tests.shipped import shipped_exercises
from tests.solutions.solved import solved

CONNECTIONS: Final = 8
CLASS: Final = 120
# The promises: the least throughput as a share of grading alone on one core; the longest wait as a
# multiple of the mean grading; the longest time for a class at once as a multiple of its gradings.
SHARE, LONGEST, AT_ONCE = 0.8, 20.0, 1.5
_COLUMNS: Final = ("a", "alpha", "d", "theta")
# Replacements for a cell.
_SLIPS: Final = ("-({})", "0", "2*({})", "({})/2", "({}) + 90deg", "l9", "({})*180/pi", "", "{} +")


class Body(NamedTuple):
    """The id of an exercise, and the body of a submission to it."""

    exercise: str
    content: bytes


def _with_slips(rows: Sequence[dict[str, str]], choose: random.Random, slips: int) -> Any:
    changed = [dict(row) for row in rows]
    for _ in range(slips):
        row, column = choose.choice(changed), choose.choice(_COLUMNS)
        other = choose.choice(rows)[choose.choice(_COLUMNS)]
        row[column] = choose.choice([*_SLIPS, other, other]).format(row[column])
    return {"rows": changed}


@cache
def _models(names: tuple[str, ...] | None) -> list[tuple[Exercise, str, Any]]:
    shipped = shipped_exercises()
    return [
        (exercise, part.id, dict[str, Any](solved(exercise).answers)[part.id]["rows"])
        for exercise in map(shipped.__getitem__, shipped if names is None else names)
        for part in exercise.parts
        if part.kind == "dh_table"
    ]


def tables(seed: int, wrong: float, names: tuple[str, ...] | None = None) -> Iterator[Body]:
    """Yield tables for exercises endlessly, many of them wrong."""
    # `names` are the ids of the exercises; by default all shipped exercises.
    choose, models = random.Random(seed), _models(names)
    while True:
        exercise, part, rows = choose.choice(models)
        slips = choose.randint(1, 4) if choose.random() < wrong else 0
        answers = {part: _with_slips(rows, choose, slips)}
        # A random term makes each body different.
        spelled = json.dumps({"answers": answers}).replace('"0"', f'"0*{choose.random():.6f}"', 1)
        yield Body(exercise.id, spelled.encode())


def in_process(bodies: Sequence[Body], catalogue: dict[str, Exercise]) -> list[float]:
    found = []
    for exercise, content in bodies:
        body = validated(GradeRequest, json.loads(content), ())
        submission = body.submission(catalogue[exercise].feedback)
        began = time.thread_time()
        grade(catalogue[exercise], submission)
        found.append(time.thread_time() - began)
    return found


def _submit(line: http.client.HTTPConnection, body: Body) -> float:
    began = time.perf_counter()
    line.request("POST", f"/v1/exercises/{body.exercise}/grade", body.content)
    response = line.getresponse()
    response.read()
    assert response.status == 200, response.status
    return time.perf_counter() - began


def _processor_time(running: Service) -> float:
    fields = Path(f"/proc/{running.process.pid}/stat").read_text(encoding="ascii").split()
    return (int(fields[13]) + int(fields[14])) / 100


def in_turn(running: Service, bodies: Sequence[Body]) -> tuple[float, list[float]]:
    left, lock, waits = iter(bodies), threading.Lock(), list[float]()

    def send() -> None:
        line = http.client.HTTPConnection("127.0.0.1", running.port, timeout=ANSWER)
        while True:
            with lock:
                body = next(left, None)
            if body is None:
                break
            waits.append(_submit(line, body))
        line.close()

    threads = [threading.Thread(target=send) for _ in range(CONNECTIONS)]
    began = time.perf_counter()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return time.perf_counter() - began, waits


async def _at_once(running: Service, bodies: Sequence[Body]) -> float:
    async def connect() -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        return await asyncio.open_connection("127.0.0.1", running.port)

    lines = await asyncio.gather(*(connect() for _ in bodies))
    began = time.perf_counter()

    async def submit(line: tuple[asyncio.StreamReader, asyncio.StreamWriter], body: Body) -> None:
        reader, writer = line
        head = f"POST /v1/exercises/{body.exercise}/grade HTTP/1.1\r\nHost: x\r\n"
        writer.write(f"{head}Content-Length: {len(body.content)}\r\n\r\n".encode() + body.content)
        status = await reader.readline()
        assert status.split()[1] == b"200", status
        writer.close()

    await asyncio.gather(*map(submit, lines, bodies))
    return time.perf_counter() - began


def measure(count: int, seed: int) -> list[str]:
    catalogue = dict(shipped_exercises())
    drawn = tables(seed, 1.0)
    warm = [next(drawn) for _ in range(100)]
    bodies = [next(drawn) for _ in range(count)]
    half = tables(seed + 1, 0.5)
    of_class = [next(half) for _ in range(CLASS)]
    in_process(warm, catalogue)
    alone = in_process(bodies, catalogue)
    mean, of_class_alone = sum(alone) / count, sum(in_process(of_class, catalogue))
    with tempfile.TemporaryDirectory() as folder, service(Path(folder)) as running:
        in_turn(running, warm)
        before = _processor_time(running)
        seconds, waits = in_turn(running, bodies)
        busy = (_processor_time(running) - before) / seconds
        waits.sort()
        at_once = asyncio.run(_at_once(running, of_class))
    share = count * mean / seconds
    p50, p99 = (waits[int(quantile * count)] / mean for quantile in (0.5, 0.99))
    times = at_once / of_class_alone
    print(f"{count} wrong tables: {1 / mean:.0f} gradings a second in process")  # noqa: T201
    print(f"over HTTP {count / seconds:.0f} a second, {100 * share:.0f} %; busy {100 * busy:.0f} %")  # noqa: T201
    print(f"waits in gradings: p50 {p50:.1f}, p99 {p99:.1f}")  # noqa: T201
    print(f"{CLASS} at once, half wrong: {at_once:.2f} s, {times:.2f} of their gradings")  # noqa: T201
    broken = []
    if share < SHARE:
        broken.append(f"the service grades {100 * share:.0f} % of what one core does")
    if p99 > LONGEST:
        broken.append(f"one in a hundred waits for {p99:.0f} gradings")
    if times > AT_ONCE:
        broken.append(f"a class at once takes {times:.2f} of its gradings")
    return broken


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    broken = measure(options.count, options.seed)
    for line in broken:
        print(line, file=sys.stderr)  # noqa: T201
    return 1 if broken else 0


if __name__ == "__main__":
    raise SystemExit(main())
