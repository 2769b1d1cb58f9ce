"""Measure the store with many attempts: ``python -m tests.attempts.campaign [--count N]``.

Prints the time of a page, of the statistics of an exercise and of a regrade, then the share of its
throughput that a graded POST keeps where it is recorded (SQLite, one server, both in turn).
"""

import argparse
import random
import tempfile
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import httpx
from rich.console import Console
from sqlalchemy import func, insert, select

from service.attempts.database import in_transaction
from service.attempts.reading import AttemptFilter, page
from service.attempts.recording import outcome_id
from service.attempts.regrading import Regrading
from service.attempts.statistics import exercise_statistics
from service.attempts.store import AttemptStore
from service.attempts.tables import attempts
from service.catalogue import Exercise, FeedbackLevel, load_catalogue, shipped_folder
from tests.api.serving import served
from tests.attempts.recorded import NOON, new_attempt

# Entries of a class: most are right, each cell has its common slips.
CELLS = (
    ("a1", "a1", "0", "d1"), ("0", "0", "0", "180deg"), ("0", "0", "a1"), ("θ1", "θ1", "-θ1", "0"),
    ("a2", "a2", "a1", "0"), ("180deg", "0", "-180deg", "90deg"), ("0", "0", "d2"), ("θ2", "-θ2"),
    ("0", "0", "a3"), ("0", "0", "180deg"), ("d3", "d3", "-d3", "0"), ("0", "0", "θ3"),
    ("0", "0"), ("0", "0", "180deg"), ("d4", "-d4", "0"), ("θ4", "-θ4", "q4"),
)  # fmt: skip
TABLES = 2000
REGRADED = 10_000
POSTS = 1500
CLIENTS = 16

show = Console(highlight=False, soft_wrap=True).print


def table(dice: random.Random) -> str:
    """A table with about two slips."""
    cells = [dice.choice(each) if dice.random() < 0.25 else each[0] for each in CELLS]
    return "\n".join(" ".join(cells[i : i + 4]) for i in range(0, 16, 4))


def fill(store: AttemptStore, exercise: Exercise, count: int) -> None:
    """Record ``count`` attempts of a few thousand different tables."""
    dice = random.Random(1)
    graded = [new_attempt(exercise, "l", table(dice)) for _ in range(min(TABLES, count))]
    rows = []
    ids: dict[str, int] = {}
    with store.engine.connect() as connection:
        connection = connection.execution_options(writes=True)
        with connection.begin():
            for i in range(count):
                new, outcome = dice.choice(graded)
                if outcome.digest not in ids:
                    ids[outcome.digest] = outcome_id(connection, outcome)
                new = replace(
                    new, learner=f"l{i // 5}", ordinal=i % 5 + 1, at=NOON + timedelta(minutes=i)
                )
                values = {name: getattr(new, name) for name in new.__dataclass_fields__}
                rows.append(values | {"id": f"{i:032x}", "outcome": ids[outcome.digest]})
            connection.execute(insert(attempts), rows)
    show(f"{count} attempts, {len(ids)} outcomes, {len(graded)} different tables")


def timed(work: Callable[[], object]) -> float:
    """The least seconds of five."""
    took = []
    for _ in range(5):
        begun = time.perf_counter()
        work()
        took.append(time.perf_counter() - begun)
    return min(took)


def read(store: AttemptStore) -> None:
    """Time pages and statistics."""
    pages = {
        "first page": AttemptFilter(),
        "of an exercise": AttemptFilter(exercise="scara"),
        "of a learner": AttemptFilter(learner="l7"),
        "oldest of the exercise": AttemptFilter(exercise="scara", until=NOON + timedelta(hours=2)),
        "not counted (none)": AttemptFilter(exercise="scara", counted=False),
    }
    with store.engine.connect() as connection:
        for name, wanted in pages.items():
            seconds = timed(lambda wanted=wanted: page(connection, wanted, None, 100))  # type: ignore[misc]
            show(f"page, {name}: {seconds * 1e3:.1f} ms (at most 50)")
        wanted = AttemptFilter(exercise="scara")
        seconds = timed(lambda: exercise_statistics(connection, wanted))
        show(f"statistics: {seconds:.2f} s (at most 1)")


def regrade(store: AttemptStore, exercise: Exercise) -> None:
    """Time the regrade of ten thousand attempts in this process."""
    regrading = Regrading(replace(exercise, version="corrected"), FeedbackLevel.HINTS)
    in_transaction(store.engine, regrading.enqueue)
    done, begun, used = 0, time.perf_counter(), time.process_time()
    while done < REGRADED and (batch := in_transaction(store.engine, regrading.work)):
        done += len(batch)
    took, used = time.perf_counter() - begun, time.process_time() - used
    show(f"regrade of {done}: {took:.1f} s, {used:.1f} s of processor time (at most 60)")


def posts(catalogue: Mapping[str, Exercise]) -> None:
    """Compare graded POSTs with recorded ones, in turn on one server."""
    with tempfile.TemporaryDirectory() as folder:
        database = str(Path(folder) / "attempts.db")
        with served(Path(folder), DH_GRADER_DATABASE=database) as server:
            rates: dict[str, list[float]] = {"grade": [], "attempts": []}
            for _ in range(3):
                for route, found in rates.items():
                    found.append(rate(f"{server.address}/v1/exercises/scara/{route}", route))
        graded, recorded = (max(found) for found in rates.values())
        show(f"POST grade: {graded:.0f}/s, POST attempts: {recorded:.0f}/s")
        show(f"a recorded one keeps {recorded / graded:.0%} of the throughput (at least 67 %)")


def rate(url: str, route: str) -> float:
    """Answers a second for clients that post different tables."""
    dice = random.Random(2)
    bodies = [{"answers": {"table": table(dice)}} for _ in range(POSTS)]
    with httpx.Client(limits=httpx.Limits(max_connections=CLIENTS), timeout=60) as client:

        def post(i: int) -> int:
            more = {"learner": f"l{i}-{time.monotonic_ns()}"} if route == "attempts" else {}
            return client.post(url, json=bodies[i] | more).status_code

        begun = time.perf_counter()
        with ThreadPoolExecutor(CLIENTS) as pool:
            statuses = set(pool.map(post, range(POSTS)))
        took = time.perf_counter() - begun
    assert statuses in ({200}, {201}), statuses
    return POSTS / took


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--url", help="an empty database; by default a new file of SQLite")
    options = parser.parse_args()
    catalogue = load_catalogue(shipped_folder())
    with tempfile.TemporaryDirectory() as folder:
        store = AttemptStore.open(options.url or str(Path(folder) / "attempts.db"))
        fill(store, catalogue["scara"], options.count)
        with store.engine.connect() as connection:
            assert connection.scalar(select(func.count()).select_from(attempts)) == options.count
        read(store)
        regrade(store, catalogue["scara"])
        store.close()
    posts(catalogue)


if __name__ == "__main__":
    main()
