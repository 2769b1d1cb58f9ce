"""`python -m tests.load.sizing`: measure one process, and simulate classes before a deadline.

Print processor times, waiting times, and the largest class that one, two and eight processes can
serve.
"""

# The program prints the processor time of each kind of request. For one, two and eight processes,
# it prints the waiting times of 10,000 students, and the size of the largest class that does not
# wait too long. It also prints how many attempts fit into a GB. Do not run other programs during
# the measurement.

import argparse
import http.client
import itertools
import json
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

import numpy as np

from tests.guards import ANSWER
from tests.load.sizing.deadline import Costs, Numbers, most_students, waits
from tests.load.wrong_answers import Body, in_process, tables
from tests.server.raw import Service, service
from tests.shipped import shipped_exercises
from tests.store.databases import new_file

PROCESSES: Final = (1, 2, 8)
P99: Final = 1.0
# The exercise of the page and of the previews.
EXERCISE: Final = "stanford-arm"
PREVIEW: Final = json.dumps({"text": "theta1 + pi/2", "exercise": EXERCISE}).encode()
Send = Callable[[http.client.HTTPConnection, int], None]


def processor_time(running: Service) -> float:
    """Return the processor seconds of a process so far."""
    fields = Path(f"/proc/{running.process.pid}/stat").read_text(encoding="ascii").split()
    return (int(fields[13]) + int(fields[14])) / 100


def each(running: Service, send: Send, count: int) -> float:
    line = http.client.HTTPConnection("127.0.0.1", running.port, timeout=ANSWER)
    send(line, -1)
    began = processor_time(running)
    for i in range(count):
        send(line, i)
    line.close()
    return (processor_time(running) - began) / count


def answered(line: http.client.HTTPConnection, method: str, path: str, body: bytes = b"") -> bytes:
    """Send a request that must succeed; return the body of the response."""
    line.request(method, path, body or None)
    response = line.getresponse()
    content = response.read()
    assert response.status < 300, (response.status, content)
    return content


def measured(running: Service, count: int) -> Costs:
    catalogue = dict(shipped_exercises())

    def graded(bodies: list[Body], route: str) -> Numbers:
        def send(line: http.client.HTTPConnection, i: int) -> None:
            exercise, content = bodies[i]
            if route == "attempts":
                content = json.dumps({"learner": f"u{i}"} | json.loads(content)).encode()
            answered(line, "POST", f"/v1/exercises/{exercise}/{route}", content)

        alone = np.array(in_process(bodies, catalogue))
        # What HTTP, the application and the record cost besides a grading.
        besides = each(running, send, len(bodies)) - alone.mean()
        found: Numbers = alone + max(besides, 0.0)
        return found

    def page(line: http.client.HTTPConnection, _: int) -> None:
        answered(line, "GET", f"/exercises/{EXERCISE}")

    def preview(line: http.client.HTTPConnection, _: int) -> None:
        answered(line, "POST", "/v1/preview", PREVIEW)

    def bodies(seed: int, wrong: float) -> list[Body]:
        return [*itertools.islice(tables(seed, wrong), count)]

    return {
        "page": np.array([each(running, page, count)]),
        "preview": np.array([each(running, preview, count)]),
        "right": graded(bodies(1, 0.0), "grade"),
        "wrong": graded(bodies(2, 1.0), "grade"),
        "hand_in": graded(bodies(3, 0.3), "attempts"),
    }


def report(costs: Costs, students: int) -> Iterable[str]:
    for kind, seconds in costs.items():
        slow = np.quantile(seconds, 0.99)
        yield f"{kind}: {seconds.mean() * 1000:.1f} ms on average, p99 {slow * 1000:.0f} ms"
    for processes in PROCESSES:
        found = waits(students, processes, costs, np.random.default_rng(1))
        most = most_students(processes, costs, P99, np.random.default_rng(1))
        yield (
            f"{students} students, {processes} processes: p50 {found.median * 1000:.0f} ms, "
            f"p99 {found.p99:.2f} s, longest {found.longest:.1f} s, "
            f"busiest minute {found.busiest:.0%}; p99 within {P99:g} s: {most} students"
        )


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--students", type=int, default=10_000)
    parser.add_argument("--count", type=int, default=2000)
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        with service(folder, DH_GRADER_DATABASE=new_file(folder)) as running:
            empty = sum(file.stat().st_size for file in folder.glob("attempts.db*"))
            costs = measured(running, given.count)
        size = -empty + sum(file.stat().st_size for file in folder.glob("attempts.db*"))
    for line in report(costs, given.students):
        sys.stdout.write(f"{line}\n")
    sys.stdout.write(f"{given.count / size * 1e9:,.0f} attempts with their reports fit into a GB\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
