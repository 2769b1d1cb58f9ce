"""Measure how long honest clients wait for responses during an attack."""

import http.client
import threading
import time
from collections.abc import Callable, Container, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from tests.guards import ANSWER
from tests.load.wrong_answers import tables
from tests.server.raw import Service

CLIENTS = 6
EXERCISE = "stanford-arm"
GRADE = f"/v1/exercises/{EXERCISE}/grade"


@dataclass
class Waits:
    """The waiting times in seconds, and the failed requests."""

    seconds: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    # The numbers of the bodies that were answered, in the order of ``seconds``.
    bodies: list[int] = field(default_factory=list)

    def of(self, bodies: Container[int]) -> "Waits":
        """Return the waiting times of these bodies."""
        both = zip(self.seconds, self.bodies, strict=True)
        return Waits([seconds for seconds, body in both if body in bodies])

    def quantile(self, share: float) -> float:
        ordered = sorted(self.seconds) or [float("nan")]
        return ordered[min(int(len(ordered) * share), len(ordered) - 1)]

    def __str__(self) -> str:
        p50, p99, longest = (1e3 * self.quantile(share) for share in (0.5, 0.99, 1.0))
        failed = f", {len(self.failures)} failed: {self.failures[0]}" if self.failures else ""
        return (
            f"{len(self.seconds)} answers, p50 {p50:.0f} p99 {p99:.0f} max {longest:.0f} ms{failed}"
        )


@contextmanager
def watched(
    running: Service, pause: float = 0.0, source: str = "127.0.0.2"
) -> Iterator[tuple[Waits, Waits]]:
    """Run honest clients in the ``with`` block, and yield their waiting times."""
    # Each client pauses for `pause` seconds after each response.
    submissions, health = Waits(), Waits()
    over = threading.Event()

    def ask(waits: Waits, send: Callable[[http.client.HTTPConnection], int], pause: float) -> None:
        connection = http.client.HTTPConnection(
            "127.0.0.1", running.port, timeout=ANSWER, source_address=(source, 0)
        )
        while not over.is_set():
            began = time.perf_counter()
            try:
                number = send(connection)
                response = connection.getresponse()
                response.read()
                if response.status == 200:
                    waits.seconds.append(time.perf_counter() - began)
                    waits.bodies.append(number)
                else:
                    waits.failures.append(str(response.status))
            except (OSError, http.client.HTTPException) as error:
                waits.failures.append(repr(error))
                connection.close()
            over.wait(pause)
        connection.close()

    # The same bodies in each run, half of them with one to four slips.
    bodies = enumerate(tables(seed=1, wrong=0.5))
    next(bodies)
    lock = threading.Lock()

    def grade(connection: http.client.HTTPConnection) -> int:
        with lock:
            number, body = next(bodies)
        connection.request("POST", f"/v1/exercises/{body.exercise}/grade", body.content)
        return number

    def alive(connection: http.client.HTTPConnection) -> int:
        connection.request("GET", "/healthz")
        return 0

    threads = [
        *(threading.Thread(target=ask, args=(submissions, grade, pause)) for _ in range(CLIENTS)),
        threading.Thread(target=ask, args=(health, alive, 0.05)),
    ]
    for thread in threads:
        thread.start()
    try:
        yield submissions, health
    finally:
        over.set()
        for thread in threads:
            thread.join()
