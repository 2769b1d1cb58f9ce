"""`python -m tests.load`: measure the service while 200 clients submit for a minute.

Print throughput and waiting times. Exit with 1 if a request fails, or if an attempt is lost or
recorded twice.
"""

# It also prints the throughput as a share of that of trivial POSTs, and exits with 1 if an attack
# with the costliest bodies makes the p99 more than five times as long.

import argparse
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from dh_grader.store.database import open_database
from dh_grader.store.tables import attempts
from sqlalchemy import select

from tests.attack.floods import costly
from tests.load.clients import Mix, Results, submitted
from tests.server.raw import Service, service
from tests.store.databases import KINDS, new_database, new_file, postgresql_server

P99 = 5.0
MIXED = Mix(recorded=0.5)


def misrecorded(url: str, results: dict[str, str]) -> list[str]:
    engine = open_database(url)
    with engine.connect() as connection:
        rows = connection.execute(select(attempts.c.idempotency_key, attempts.c.id)).all()
    engine.dispose()
    recorded = {row.idempotency_key: row.id for row in rows}
    lost = [key for key, found in results.items() if recorded.get(key) != found]
    found = [f"{len(lost)} attempts are lost, such as {lost[0]}"] if lost else []
    if len(rows) != len(recorded):
        found.append(f"{len(rows) - len(recorded)} attempts were recorded twice")
    if strangers := recorded.keys() - results.keys():
        found.append(f"{len(strangers)} recorded attempts were never confirmed to a client")
    return found


@contextmanager
def replicas(
    folder: Path, number: int, workers: int, url: str, **settings: str
) -> Iterator[list[Service]]:
    with ExitStack() as stack:
        running = []
        for i in range(number):
            (place := folder / f"replica{i}").mkdir()
            running.append(
                stack.enter_context(
                    service(
                        place, "--workers", str(workers), module="tests.benchmarks.app",
                        DH_GRADER_DATABASE=url, **settings,
                    )
                )
            )  # fmt: skip
        for each in running:
            while each.log.count("startup complete") < workers:
                time.sleep(0.02)
        yield running


@contextmanager
def attacked(running: Sequence[Service], seconds: float) -> Iterator[None]:
    with ExitStack() as opened:
        until = time.monotonic() + seconds
        thread = threading.Thread(target=lambda: costly()(running[0], opened, until))
        thread.start()
        yield
        thread.join()


@contextmanager
def database(kind: str, folder: Path) -> Iterator[str]:
    """Yield the URL of a new SQLite or PostgreSQL database."""
    if kind == "sqlite":
        yield new_file(folder)
        return
    with postgresql_server() as server:
        yield new_database(server, "attempts")


def load(kind: str, number: int, workers: int, clients: int, seconds: float) -> list[str]:
    broken: list[str] = []
    rows: list[tuple[str, Results]] = []
    with (
        tempfile.TemporaryDirectory() as name,
        database(kind, Path(name)) as url,
        replicas(Path(name), number, workers, url) as running,
    ):
        ports = [each.port for each in running]
        submitted(ports, clients, 1.0, Mix(), "warm")
        for called, mix in (
            ("trivial", Mix(trivial=1.0)),
            ("graded", Mix()),
            ("recorded", Mix(recorded=1.0)),
            ("both", MIXED),
        ):
            span = seconds if mix is MIXED else seconds / 4
            rows.append((called, submitted(ports, clients, span, mix, called)))
        with attacked(running, seconds):
            rows.append(("both, attacked", submitted(ports, clients, seconds, MIXED, "attacked")))
        for called, results in rows:
            broken += [f"{called}: {failure}" for failure in results.failures[:3]]
            if results.lost_connections or results.refused:
                lost = f"{results.lost_connections} connections lost"
                broken.append(f"{called}: {lost}, {results.refused} attempts refused")
        everything = {key: found for _, results in rows for key, found in results.attempts.items()}
        broken += misrecorded(url, everything)
        for each in running:
            if each.end():
                broken.append("a service did not shut down with exit code 0")
    _print(f"{clients} clients, {number} x {workers} processes, {kind}", rows)
    longer = rows[-1][1].quantile(0.99) / rows[-2][1].quantile(0.99)
    print(f"during an attack, p99 is {longer:.1f} times as long")  # noqa: T201
    if longer > P99:
        broken.append(f"p99 is {longer:.1f} times as long during an attack")
    return broken


def _print(title: str, rows: Sequence[tuple[str, Results]]) -> None:
    print(title)  # noqa: T201
    print(  # noqa: T201
        f"{'':16}{'answers':>9}{'a second':>10}{'p50 ms':>9}{'p99 ms':>9}{'of trivial':>12}"
    )
    trivial = rows[0][1].per_second
    for called, results in rows:
        p50, p99 = (1e3 * results.quantile(share) for share in (0.5, 0.99))
        print(  # noqa: T201
            f"{called:16}{len(results.waits):9}{results.per_second:10.0f}{p50:9.0f}{p99:9.0f}"
            f"{results.per_second / trivial:12.0%}"
        )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="for each mixed load")
    parser.add_argument("--clients", type=int, default=200)
    parser.add_argument("--database", choices=KINDS, default="sqlite")
    parser.add_argument("--replicas", type=int, default=1, help="services over one database")
    parser.add_argument("--workers", type=int, default=2, help="processes of each")
    options = parser.parse_args()
    broken = load(
        options.database, options.replicas, options.workers, options.clients, options.seconds
    )
    for line in broken:
        print(line, file=sys.stderr)  # noqa: T201
    return 1 if broken else 0


if __name__ == "__main__":
    raise SystemExit(main())
