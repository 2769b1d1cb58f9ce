"""Compare graded POSTs with trivial POSTs on one server."""

# All seconds are processor time of the server, so that other programs do not count.

import asyncio
import contextlib
import json
import secrets
import statistics
import tempfile
import time
import urllib.request
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path

from dh_grader.contract.courses import NewAssignment, NewCourse, NewLearner
from dh_grader.courses import roll
from dh_grader.courses.assignments import add_assignment
from dh_grader.store.database import in_transaction, open_database
from sqlalchemy import Connection

from tests.benchmarks.answers import T06, distinct, one_student_s_table, table
from tests.server.raw import service

CONNECTIONS = 8
# Seconds of trivial and of graded POSTs each, and the number of rounds in which they take turns.
SECONDS = 6.0
ROUNDS = 20
# The number of bodies in one round.
MOST = 600
# The most seconds until all workers of a server have started.
START = 60.0
GRADE = "/v1/exercises/stanford-arm/grade"
RECORD = "/v1/exercises/stanford-arm/attempts"
HAND_IN = "/v1/courses/robots/assignments/homework/attempts"
# The learners of the course, who hand in one after the other.
LEARNERS = 1000
TRIVIAL = "/trivial"
CLOCK = "/processor-seconds"


def right_tables(i: int) -> bytes:
    wrong_ones = i // 2 + 1
    return json.dumps({"answers": {"table": table(one_student_s_table(i + wrong_ones))}}).encode()


def tables(i: int) -> bytes:
    return json.dumps({"answers": {"table": table(one_student_s_table(i))}}).encode()


def tables_and_poses(i: int) -> bytes:
    answers = {"table": table(one_student_s_table(i)), "pose": distinct(T06, i)}
    return json.dumps({"answers": answers}).encode()


def attempts(i: int) -> bytes:
    return json.dumps(json.loads(tables(i)) | {"learner": f"learner {i}"}).encode()


def hand_ins(i: int) -> bytes:
    learner = {"exercise": "stanford-arm", "learner": f"u{i % LEARNERS}"}
    return json.dumps(json.loads(tables(i)) | learner).encode()


BODIES: dict[str, Callable[[int], bytes]] = {
    "right tables": right_tables,
    "tables, one in three wrong": tables,
    "the same and new poses": tables_and_poses,
}


def _processor_seconds(port: int) -> float:
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{CLOCK}", timeout=60) as answer:
        return float(answer.read())


def request(path: str, body: bytes) -> bytes:
    """Return the bytes of a POST request."""
    # A hand-in needs a key of its own.
    key = f"Idempotency-Key: {secrets.token_hex(8)}\r\n" if path == HAND_IN else ""
    head = (
        f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n{key}"
        f"Content-Length: {len(body)}\r\n\r\n"
    )
    return head.encode() + body


@contextlib.contextmanager
def running_server(
    workers: int = 1, /, module: str = "tests.benchmarks.app", **settings: str
) -> Iterator[int]:
    with tempfile.TemporaryDirectory() as folder:
        options = ("--workers", str(workers))
        # The modules are compiled once, as for an installed program, and not at each start.
        settings = {"PYTHONDONTWRITEBYTECODE": "", **settings}
        with service(Path(folder), *options, module=module, **settings) as running:
            end = time.monotonic() + START
            while running.log.count("startup complete") < workers:
                # A worker that fails is started again and again.
                if "Traceback" in running.log or time.monotonic() > end:
                    raise RuntimeError(running.log)
                time.sleep(0.02)
            yield running.port


async def post_all(port: int, requests: list[bytes], deadline: float) -> int:
    """Send requests one after the other until the deadline; return the number of responses."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    done = 0
    for message in requests:
        if time.perf_counter() > deadline:
            break
        writer.write(message)
        head = await reader.readuntil(b"\r\n\r\n")
        if not head.startswith((b"HTTP/1.1 200", b"HTTP/1.1 201")):
            raise RuntimeError(head.decode())
        length = int(head.lower().split(b"content-length:")[1].split(b"\r\n")[0])
        await reader.readexactly(length)
        done += 1
    writer.close()
    return done


async def _posted(port: int, path: str, messages: list[bytes]) -> tuple[int, float]:
    shares = [
        [request(path, body) for body in messages[i::CONNECTIONS]] for i in range(CONNECTIONS)
    ]
    deadline, start = time.perf_counter() + SECONDS / ROUNDS, _processor_seconds(port)
    counts = await asyncio.gather(*(post_all(port, share, deadline) for share in shares))
    return sum(counts), _processor_seconds(port) - start


def posts_per_second(body: Callable[[int], bytes]) -> dict[str, float]:
    trivial, graded = _in_turn({TRIVIAL: body, GRADE: body})
    return {"trivial": trivial, "graded": graded}


def recorded_per_second() -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        database = str(Path(folder) / "attempts.db")
        graded, recorded = _in_turn({GRADE: tables, RECORD: attempts}, DH_GRADER_DATABASE=database)
    return {"graded": graded, "recorded": recorded}


def handed_in_per_second() -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        database = str(Path(folder) / "attempts.db")
        _set_up_course(database)
        graded, handed_in = _in_turn(
            {GRADE: tables, HAND_IN: hand_ins}, DH_GRADER_DATABASE=database
        )
    return {"graded": graded, "handed in": handed_in}


def _set_up_course(database: str) -> None:
    engine, now = open_database(database), datetime.now(UTC)
    assigned = NewAssignment.model_validate(
        {
            "id": "homework",
            "title": "Homework",
            "exercises": [{"exercise": "stanford-arm", "points": 10}],
            "due": (now + timedelta(days=1)).isoformat(),
            "limit": 100,
        }
    )

    def work(connection: Connection) -> None:
        course = NewCourse(id="robots", title="Robots", zone="Europe/Berlin")
        roll.add_course(connection, course, now)
        learners = (NewLearner(learner=f"u{i}", name=f"Learner {i}") for i in range(LEARNERS))
        roll.add_learners(connection, "robots", learners)
        add_assignment(connection, "robots", assigned, {"stanford-arm"})

    in_transaction(engine, work)
    engine.dispose()


def _in_turn(bodies: Mapping[str, Callable[[int], bytes]], **settings: str) -> Iterator[float]:
    # Measure the paths in turn on one server; yield the number of POSTs per second for each path.
    #
    # The number of the first path is the median of all rounds. Every other path is compared with
    # the first path in the same round, because a slow machine hardly changes their ratio. Its
    # number is the median ratio times the number of the first path.
    messages = {
        path: [body(i) for i in range(100 + ROUNDS * MOST)] for path, body in bodies.items()
    }
    rates: dict[str, list[float]] = {path: [] for path in bodies}
    with running_server(**settings) as port:
        for path in rates:
            asyncio.run(_posted(port, path, messages[path][:100]))
        for i in range(100, 100 + ROUNDS * MOST, MOST):
            for path, measured in rates.items():
                count, seconds = asyncio.run(_posted(port, path, messages[path][i : i + MOST]))
                measured.append(count / seconds)
    first = next(iter(rates.values()))
    for measured in rates.values():
        ratios = (rate / other for rate, other in zip(measured, first, strict=True))
        yield statistics.median(first) * statistics.median(ratios)


def graded_per_second(workers: int) -> float:
    """Return the number of graded POSTs per second with this number of workers."""
    messages = [tables(i) for i in range(400 + ROUNDS * MOST)]
    with running_server(workers) as port:
        asyncio.run(_per_second(port, messages[:400]))
        rates = [
            asyncio.run(_per_second(port, messages[i : i + MOST]))
            for i in range(400, len(messages), MOST)
        ]
    return statistics.median(rates)


async def _per_second(port: int, messages: list[bytes]) -> float:
    start = time.perf_counter()
    count, _ = await _posted(port, GRADE, messages)
    return count / (time.perf_counter() - start)


def first_answer_seconds() -> float:
    """Return the seconds from the server's start to its first report."""
    start = time.perf_counter()
    with running_server(module="dh_grader") as port:
        asyncio.run(post_all(port, [request(GRADE, tables_and_poses(1))], time.perf_counter() + 10))
        return time.perf_counter() - start
