"""Clients that send one request after the other; each client has its own address."""

import asyncio
import json
import random
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final

from tests.benchmarks.answers import one_student_s_table, table
from tests.guards import ANSWER

EXERCISE: Final = "stanford-arm"
GRADE: Final = f"/v1/exercises/{EXERCISE}/grade"
ATTEMPTS: Final = f"/v1/exercises/{EXERCISE}/attempts"
TRIVIAL: Final = "/trivial"
# One in 20 attempts is sent again under its key, as after a lost answer.
AGAIN: Final = 20
# How often an attempt is sent again if it is refused or not answered.
TRIES: Final = 300


@dataclass
class Results:
    """The waiting times, failures and attempt ids of clients."""

    waits: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    attempts: dict[str, str] = field(default_factory=dict)
    lost_connections: int = 0
    # The number of answers 503 to attempts, because the database was down.
    refused: int = 0
    seconds: float = 0.0

    @property
    def per_second(self) -> float:
        return len(self.waits) / self.seconds

    def quantile(self, share: float) -> float:
        ordered = sorted(self.waits) or [float("nan")]
        return ordered[min(int(len(ordered) * share), len(ordered) - 1)]


@dataclass(frozen=True)
class Mix:
    """The fractions of requests that are recorded, trivial, or only graded."""

    recorded: float = 0.0
    trivial: float = 0.0


class Client:
    """A student who sends requests one by one, and waits for each response."""

    def __init__(
        self,
        number: int,
        ports: Sequence[int],
        mix: Mix,
        results: Results,
        run: str,
        pause: float = 0.0,
    ) -> None:
        self._pause = pause
        self._name = f"{run}.{number}"
        # Each client has an address of its own, because turns are fair between addresses.
        self._source = f"127.1.{number // 250}.{number % 250 + 1}"
        self._ports = ports
        self._random = random.Random(number)
        self._mix = mix
        self._results = results
        self._turn = number
        self._lines: dict[int, tuple[asyncio.StreamReader, asyncio.StreamWriter]] = {}

    async def submit(self, until: float) -> None:
        for i in range(1_000_000):
            if time.perf_counter() > until:
                break
            choice = self._random.random()
            if choice < self._mix.trivial:
                await self._post(TRIVIAL, self._answers(i))
            elif choice < self._mix.trivial + self._mix.recorded:
                await self._attempt(i)
            else:
                await self._post(GRADE, self._answers(i))
            await asyncio.sleep(self._pause)
        for _, writer in self._lines.values():
            writer.close()

    def _answers(self, i: int) -> dict[str, object]:
        number = hash((self._name, i)) & 0xFFFFFF
        return {"answers": {"table": table(one_student_s_table(number))}}

    async def _attempt(self, i: int) -> None:
        key = f"{self._name}.{i}"
        body = {"learner": self._name, **self._answers(i)}
        found = await self._post(ATTEMPTS, body, key)
        if found and self._random.randrange(AGAIN) == 0:
            again = await self._post(ATTEMPTS, body, key)
            if again and again != found:
                self._results.failures.append(f"{key} was recorded twice")
        for _ in range(TRIES):
            if found:
                break
            # As documented, send the same attempt again until an answer says that it is recorded.
            found = await self._post(ATTEMPTS, body, key)
        else:
            self._results.failures.append(f"{key} was never recorded")
            return
        self._results.attempts[key] = found

    async def _post(self, path: str, body: dict[str, object], key: str = "") -> str:
        self._turn += 1
        port = self._ports[self._turn % len(self._ports)]
        content = json.dumps(body).encode()
        named = f"Idempotency-Key: {key}\r\n" if key else ""
        head = (
            f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
            f"{named}Content-Length: {len(content)}\r\n\r\n"
        )
        began = time.perf_counter()
        try:
            status, answer = await asyncio.wait_for(
                self._exchange(port, head.encode() + content), ANSWER
            )
        except (OSError, EOFError):
            self._results.lost_connections += 1
            with suppress(KeyError):
                self._lines.pop(port)[1].close()
            await asyncio.sleep(0.05)
            return ""
        except TimeoutError:
            self._results.failures.append(f"{path}: no answer")
            return ""
        if key and status == 503 and b":store-down" in answer:
            self._results.refused += 1
            await asyncio.sleep(0.1)
            return ""
        if status != (201 if key else 200):
            self._results.failures.append(f"{path}: {status} {answer[:200].decode()}")
            return ""
        self._results.waits.append(time.perf_counter() - began)
        return str(json.loads(answer)["attempt"]["id"]) if key else ""

    async def _exchange(self, port: int, message: bytes) -> tuple[int, bytes]:
        if port not in self._lines:
            self._lines[port] = await asyncio.open_connection(
                "127.0.0.1", port, local_addr=(self._source, 0)
            )
        reader, writer = self._lines[port]
        writer.write(message)
        head = await reader.readuntil(b"\r\n\r\n")
        length = int(head.lower().partition(b"content-length:")[2].split(b"\r\n")[0])
        return int(head.split(b" ", 2)[1]), await reader.readexactly(length)


async def _submit_all(clients: Sequence[Client], seconds: float) -> None:
    until = time.perf_counter() + seconds
    await asyncio.gather(*(client.submit(until) for client in clients))


def submitted(
    ports: Sequence[int],
    clients: int,
    seconds: float,
    mix: Mix,
    run: str,
    results: Results | None = None,
    pause: float = 0.0,
) -> Results:
    """Run clients for some seconds and return their results."""
    # Each client pauses for `pause` seconds after each response.
    results = Results() if results is None else results
    began = time.perf_counter()
    everybody = [Client(number, ports, mix, results, run, pause) for number in range(clients)]
    asyncio.run(_submit_all(everybody, seconds))
    results.seconds = time.perf_counter() - began
    return results
