"""Graded POSTs against trivial ones, on one server in one run.

A second is one of the server's processor time, in which other programs have no part.
"""

import asyncio
import contextlib
import json
import os
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator

from tests.benchmarks.answers import T06, distinct, one_student_s_table, table

CONNECTIONS = 8
# Of trivial POSTs, and as many of graded ones; the two take turns so often.
SECONDS = 9.0
ROUNDS = 20
# The bodies of one turn.
MOST = 900
GRADE = "/v1/exercises/stanford-arm/grade"
TRIVIAL = "/trivial"
CLOCK = "/processor-seconds"


def right_tables(i: int) -> bytes:
    """A right table, spelled in a way of its own."""
    wrong_ones = i // 2 + 1
    return json.dumps({"answers": {"table": table(one_student_s_table(i + wrong_ones))}}).encode()


def tables(i: int) -> bytes:
    """A student's table, spelled in a way of its own; one in three is wrong somewhere."""
    return json.dumps({"answers": {"table": table(one_student_s_table(i))}}).encode()


def tables_and_poses(i: int) -> bytes:
    """A table, and a pose in which every entry is a text that nobody has written before."""
    answers = {"table": table(one_student_s_table(i)), "pose": distinct(T06, i)}
    return json.dumps({"answers": answers}).encode()


BODIES: dict[str, Callable[[int], bytes]] = {
    "right tables": right_tables,
    "tables, one in three wrong": tables,
    "the same and new poses": tables_and_poses,
}


def _processor_seconds(port: int) -> float:
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{CLOCK}", timeout=60) as answer:
        return float(answer.read())


def request(path: str, body: bytes) -> bytes:
    """One POST as it goes over the wire."""
    head = (
        f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        f"Content-Length: {len(body)}\r\n\r\n"
    )
    return head.encode() + body


@contextlib.contextmanager
def running_server() -> Iterator[int]:
    """The service with one trivial route more, in a process of its own; yields the port."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "uvicorn", "tests.benchmarks.app:app", "--port", str(port)]
    quiet = ["--log-level", "warning", "--no-access-log"]
    with subprocess.Popen([*command, *quiet], env=os.environ) as process:
        try:
            _wait_for(port)
            yield port
        finally:
            process.terminate()


def _wait_for(port: int) -> None:
    for _ in range(1200):
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
            return
        time.sleep(0.05)
    raise RuntimeError("the server did not start")


async def _post_all(port: int, requests: list[bytes], deadline: float) -> int:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    done = 0
    for message in requests:
        if time.perf_counter() > deadline:
            break
        writer.write(message)
        head = await reader.readuntil(b"\r\n\r\n")
        if not head.startswith(b"HTTP/1.1 200"):
            raise RuntimeError(head.decode())
        length = int(head.lower().split(b"content-length:")[1].split(b"\r\n")[0])
        await reader.readexactly(length)
        done += 1
    writer.close()
    return done


async def _posted(port: int, path: str, messages: list[bytes]) -> tuple[int, float]:
    """How many POSTs were answered, and the processor time that the server took for them."""
    shares = [
        [request(path, body) for body in messages[i::CONNECTIONS]] for i in range(CONNECTIONS)
    ]
    deadline, start = time.perf_counter() + SECONDS / ROUNDS, _processor_seconds(port)
    counts = await asyncio.gather(*(_post_all(port, share, deadline) for share in shares))
    return sum(counts), _processor_seconds(port) - start


def posts_per_second(body: Callable[[int], bytes]) -> dict[str, float]:
    """Trivial and graded POSTs in a second, in turn many times; every graded body is different."""
    messages = [body(i) for i in range(100 + ROUNDS * MOST)]
    taken: dict[str, list[tuple[int, float]]] = {TRIVIAL: [], GRADE: []}
    with running_server() as port:
        for path in taken:
            asyncio.run(_posted(port, path, messages[:100]))
        for i in range(100, len(messages), MOST):
            for path, posted in taken.items():
                posted.append(asyncio.run(_posted(port, path, messages[i : i + MOST])))
    trivial, graded = (
        sum(count for count, _ in posted) / sum(seconds for _, seconds in posted)
        for posted in taken.values()
    )
    return {"trivial": trivial, "graded": graded}


def first_answer_seconds() -> float:
    """From the start of the process to the first graded answer."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    start = time.perf_counter()
    command = [sys.executable, "-m", "service", "serve", "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        try:
            _wait_for(port)
            asyncio.run(
                _post_all(port, [request(GRADE, tables_and_poses(1))], time.perf_counter() + 10)
            )
            return time.perf_counter() - start
        finally:
            process.terminate()
