"""Measure the store with many attempts: ``python -m tests.store.campaign [--count N]``.

Print the time of a page of attempts, of statistics, and of a regrade (grading attempts again).
"""

import argparse
import random
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import timedelta
from functools import partial
from pathlib import Path
from typing import Any

from dh_grader.catalogue import Exercise, FeedbackLevel, load_catalogue, shipped_folder
from dh_grader.store import AttemptFilter
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.attempts import outcome_ids
from dh_grader.store.database import in_transaction
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import exercise_statistics, page
from dh_grader.store.tables import attempts
from rich.console import Console
from sqlalchemy import Connection, insert

from tests.benchmarks.timing import floor_seconds
from tests.store.recorded import NOON, new_attempt

# The entries of a class for each cell: the right one first, then common slips.
CELLS = (
    ("a1", "a1", "0", "d1"), ("0", "0", "0", "180deg"), ("0", "0", "a1"), ("θ1", "θ1", "-θ1", "0"),
    ("a2", "a2", "a1", "0"), ("180deg", "0", "-180deg", "90deg"), ("0", "0", "d2"), ("θ2", "-θ2"),
    ("0", "0", "a3"), ("0", "0", "180deg"), ("d3", "d3", "-d3", "0"), ("0", "0", "θ3"),
    ("0", "0"), ("0", "0", "180deg"), ("d4", "-d4", "0"), ("θ4", "-θ4", "q4"),
)  # fmt: skip
TABLES = 2000
AT_ONCE = 10_000
REGRADED = 10_000
ALL_DIFFERENT = 2000

show = Console(highlight=False, soft_wrap=True).print


def table(dice: random.Random) -> str:
    cells = [dice.choice(each) if dice.random() < 0.25 else each[0] for each in CELLS]
    return "\n".join(" ".join(cells[i : i + 4]) for i in range(0, 16, 4))


def spelled(text: str, i: int) -> str:
    first, *others = text.split(" ")
    return first + "".join(" " * (1 + (i >> k & 1)) + each for k, each in enumerate(others))


def fill(
    store: AttemptStore, exercise: Exercise, count: int, *, no_two_alike: bool = False
) -> None:
    dice = random.Random(1)
    tables = [table(dice) for _ in range(count if no_two_alike else min(TABLES, count))]
    if no_two_alike:
        tables = [spelled(each, i) for i, each in enumerate(tables)]
    graded = [new_attempt(exercise, "l", each) for each in tables]

    # The columns that many rows share.
    texts = [{name: getattr(new, name) for name in new.__dataclass_fields__} for new, _ in graded]

    def row(i: int, which: int, outcome: int) -> dict[str, object]:
        own = {"id": f"{i:032x}", "learner": f"l{i // 5}", "ordinal": i % 5 + 1}
        return texts[which] | own | {"at": NOON + timedelta(minutes=i), "outcome": outcome}

    def write(connection: Connection) -> int:
        ids = outcome_ids(connection, [outcome for _, outcome in graded])
        numbers = [ids[outcome] for _, outcome in graded]
        for begin in range(0, count, AT_ONCE):
            at_once = range(begin, min(begin + AT_ONCE, count))
            chosen = [i if no_two_alike else dice.randrange(len(graded)) for i in at_once]
            rows = [row(i, which, numbers[which]) for i, which in zip(at_once, chosen, strict=True)]
            _insert(connection, rows)
        return len(ids)

    outcomes = in_transaction(store.engine, write)
    show(f"{count} attempts, {outcomes} outcomes, {len(set(tables))} different tables")


def _insert(connection: Connection, rows: Sequence[Mapping[str, Any]]) -> None:
    if connection.dialect.name != "postgresql":
        connection.execute(insert(attempts), rows)
        return
    columns = [*rows[0]]
    driver: Any = connection.connection.driver_connection
    with driver.cursor().copy(f"COPY attempts ({', '.join(columns)}) FROM STDIN") as copy:
        for each in rows:
            copy.write_row([each[name] for name in columns])


def timed(what: str, work: Callable[[], object], most: float) -> None:
    clock, processor = [], []
    for _ in range(5):
        begun, used = time.perf_counter(), time.process_time()
        work()
        clock.append(time.perf_counter() - begun)
        processor.append(time.process_time() - used)
    show(
        f"{what}: {min(clock) * 1e3:.1f} ms, {min(processor) * 1e3:.1f} ms of processor time "
        f"(at most {most:g})"
    )


def read(store: AttemptStore) -> None:
    pages = {
        "first page": AttemptFilter(),
        "of an exercise": AttemptFilter(exercise="scara"),
        "of a learner": AttemptFilter(learner="l7"),
        "oldest of the exercise": AttemptFilter(exercise="scara", until=NOON + timedelta(hours=2)),
        "not counted (none)": AttemptFilter(exercise="scara", counted=False),
    }
    with store.engine.connect() as connection:
        for name, wanted in pages.items():
            timed(f"page, {name}", partial(page, connection, wanted, None, 100), 50)
        timed("statistics", lambda: exercise_statistics(connection, pages["of an exercise"]), 1000)


def regrade(store: AttemptStore, exercise: Exercise, most: int) -> None:
    regrading = Regrading(replace(exercise, version="corrected"), FeedbackLevel.HINTS)
    in_transaction(store.engine, regrading.enqueue)
    done, begun, used = 0, time.perf_counter(), time.process_time()
    while done < most and (batch := regrading.next_batch(store.engine)):
        done += len(batch)
    took, used = time.perf_counter() - begun, time.process_time() - used
    took, used = 1e4 / done * took, 1e4 / done * used
    show(f"regrade of 10,000: {took:.1f} s, {used:.1f} s of processor time (at most 60)")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--url", help="an empty database; by default a new file of SQLite")
    options = parser.parse_args()
    scara = load_catalogue(shipped_folder())["scara"]
    show(f"floor of make bench: {floor_seconds() * 1e3:.3f} ms")
    with tempfile.TemporaryDirectory() as folder:
        store = AttemptStore.open(options.url or str(Path(folder) / "attempts.db"))
        fill(store, scara, options.count)
        read(store)
        regrade(store, scara, REGRADED)
        store.close()
        store = AttemptStore.open(str(Path(folder) / "different.db"))
        fill(store, scara, ALL_DIFFERENT, no_two_alike=True)
        regrade(store, scara, ALL_DIFFERENT)
        store.close()


if __name__ == "__main__":
    main()
