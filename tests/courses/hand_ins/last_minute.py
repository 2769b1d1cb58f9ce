"""`python -m tests.courses.hand_ins.last_minute`: a class hands in just before the due date.

Print the waiting times. Exit with 1 if a response is a failure, or if a hand-in is late, lost or
recorded twice.
"""

# 150 learners submit three exercises each within 20 seconds, most of them near the due date. Half
# of the tables have slips.

import argparse
import asyncio
import json
import os
import random
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from itertools import product
from pathlib import Path
from typing import Final

from dh_grader.courses.gradebook import gradebook
from dh_grader.store.database import open_database

from tests.courses.hand_ins.class_of_learners import (
    COURSE,
    SECRET,
    HandIn,
    Learners,
    Outcome,
    assign,
    enrol,
)
from tests.load.__main__ import database, misrecorded
from tests.load.wrong_answers import tables
from tests.server.raw import service
from tests.store.databases import KINDS

EXERCISES: Final = ("planar-rrr", "spherical-wrist", "stanford-arm")
# The last of them hands in one second before the due date.
SPARE: Final = 1.0
# The number of services over one database of each kind, and of the processes of each.
PROCESSES: Final = {"sqlite": (1, 2), "postgresql": (2, 1)}


def hand_ins(learners: Sequence[str], exercises: Sequence[str], seconds: float) -> list[HandIn]:
    choose = random.Random(1)
    drawn = {name: tables(1, 0.5, (name,)) for name in exercises}
    return [
        HandIn(
            learner,
            "homework",
            f"{learner}.{name}",
            seconds * choose.random() ** (1 / 3),
            {"exercise": name, **json.loads(next(drawn[name]).content)},
        )
        for learner, name in product(learners, exercises)
    ]


def last_minute(
    url: str,
    folder: Path,
    kind: str,
    learners: int,
    exercises: Sequence[str],
    seconds: float,
    spare: float = SPARE,
) -> tuple[Outcome, list[str]]:
    names = [f"u{i}" for i in range(learners)]
    planned = hand_ins(names, exercises, seconds)
    keys, outcome = enrol(url, names), Outcome()
    services, workers = PROCESSES[kind]
    with ExitStack() as stack:
        running = []
        for i in range(services):
            (place := folder / f"service{i}").mkdir()
            settings = {"DH_GRADER_DATABASE": url, "DH_GRADER_SECRET": SECRET}
            options = ("--workers", str(workers))
            running.append(stack.enter_context(service(place, *options, **settings)))
        for each in running:
            while each.log.count("startup complete") < workers:
                time.sleep(0.02)
        due = datetime.now(UTC) + timedelta(seconds=seconds + spare)
        assign(url, "homework", exercises, due=due.isoformat(), limit=3)
        asyncio.run(Learners([each.port for each in running], keys, outcome).all_hand_in(planned))
        broken = ["a service did not shut down with exit code 0" for each in running if each.end()]
    broken += outcome.failures + misrecorded(url, outcome.attempts)
    broken += [f"{key} was refused: {why}" for key, why in outcome.refused.items()]
    broken += [f"{key} is late" for key, is_late in outcome.is_late.items() if is_late]
    if outcome.lost_connections:
        broken.append(f"{outcome.lost_connections} connections were lost")
    missing = len(planned) - graded(url)
    if missing:
        broken.append(f"{missing} hand-ins are not in the gradebook")
    return outcome, broken


def graded(url: str) -> int:
    engine = open_database(url)
    with engine.connect() as connection:
        rows = gradebook(connection, COURSE).rows
    engine.dispose()
    return sum(each is not None for row in rows for each in row.points)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--learners", type=int, default=150)
    parser.add_argument("--seconds", type=float, default=20.0)
    options = parser.parse_args()
    broken = []
    for kind in KINDS:
        with tempfile.TemporaryDirectory() as name, database(kind, Path(name)) as url:
            outcome, found = last_minute(
                url, Path(name), kind, options.learners, EXERCISES, options.seconds
            )
        p50, p99, longest = (1e3 * outcome.quantile(share) for share in (0.5, 0.99, 1))
        services, workers = PROCESSES[kind]
        print(  # noqa: T201
            f"{kind}, {services} x {workers} processes: {len(outcome.attempts)} hand-ins of "
            f"{options.learners} learners in {options.seconds:g} s; ms: p50 {p50:.0f}, "
            f"p99 {p99:.0f}, longest {longest:.0f}; load average {os.getloadavg()[0]:.1f}"
        )
        broken += [f"{kind}: {each}" for each in found]
    for line in broken:
        print(line, file=sys.stderr)  # noqa: T201
    return 1 if broken else 0


if __name__ == "__main__":
    raise SystemExit(main())
