"""Graded POSTs against trivial ones, on one server in one run."""

import asyncio
import contextlib
import json
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from tests.benchmarks.answers import T06, distinct, one_student_s_table, table
from tests.server.raw import service

CONNECTIONS = 8
SECONDS = 3.0
GRADE = "/v1/exercises/stanford-arm/grade"
TRIVIAL = "/trivial"


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


def request(path: str, body: bytes) -> bytes:
    """One POST as it goes over the wire."""
    head = (
        f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        f"Content-Length: {len(body)}\r\n\r\n"
    )
    return head.encode() + body


@contextlib.contextmanager
def running_server(workers: int = 1, module: str = "tests.benchmarks.app") -> Iterator[int]:
    """The service with one trivial route more, in processes of its own; yields the port."""
    with tempfile.TemporaryDirectory() as folder:
        options = ("--workers", str(workers))
        with service(Path(folder), *options, module=module) as running:
            while running.log.count("startup complete") < workers:
                time.sleep(0.02)
            yield running.port


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


async def _per_second(port: int, path: str, messages: list[bytes]) -> float:
    shares = [
        [request(path, body) for body in messages[i::CONNECTIONS]] for i in range(CONNECTIONS)
    ]
    start = time.perf_counter()
    counts = await asyncio.gather(*(_post_all(port, s, start + SECONDS) for s in shares))
    return sum(counts) / (time.perf_counter() - start)


def posts_per_second(body: Callable[[int], bytes]) -> dict[str, float]:
    """Trivial and graded POSTs each second, taken in turn; every graded body is different."""
    messages = [body(i) for i in range(12_000)]
    with running_server() as port:
        asyncio.run(_per_second(port, GRADE, messages[:100]))
        asyncio.run(_per_second(port, TRIVIAL, messages[:100]))
        rounds = [
            (
                asyncio.run(_per_second(port, TRIVIAL, messages)),
                asyncio.run(_per_second(port, GRADE, messages[100 + 3000 * i : 3100 + 3000 * i])),
            )
            for i in range(3)
        ]
    trivial, graded = (sorted(values)[1] for values in zip(*rounds, strict=True))
    return {"trivial": trivial, "graded": graded}


def graded_per_second(workers: int) -> float:
    """Graded POSTs each second with so many workers; every body is different."""
    messages = [tables(i) for i in range(12_000)]
    with running_server(workers) as port:
        asyncio.run(_per_second(port, GRADE, messages[:400]))
        rates = [asyncio.run(_per_second(port, GRADE, messages[400:])) for _ in range(3)]
    return sorted(rates)[1]


def first_answer_seconds() -> float:
    """From the start of the process to the first graded answer."""
    start = time.perf_counter()
    with running_server(module="service") as port:
        asyncio.run(
            _post_all(port, [request(GRADE, tables_and_poses(1))], time.perf_counter() + 10)
        )
        return time.perf_counter() - start
