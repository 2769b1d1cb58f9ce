"""Processes of the service are killed while learners hand in."""

import asyncio
import json
import os
import random
import signal
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from dh_grader.store.database import open_database
from dh_grader.store.tables import assignments, attempts
from sqlalchemy import select

from tests.courses.hand_ins.class_of_learners import (
    SECRET,
    HandIn,
    Learners,
    Outcome,
    assign,
    enrol,
)
from tests.courses.hand_ins.last_minute import PROCESSES
from tests.load.__main__ import misrecorded
from tests.load.wrong_answers import tables
from tests.server.raw import Service, service, workers

EXERCISE = "planar-rrr"
LIMIT, PARALLEL = 3, 50
OTHERS = 10


class Fleet:
    """Several services on one database."""

    def __init__(self, url: str, folder: Path, kind: str) -> None:
        self._settings = {"DH_GRADER_DATABASE": url, "DH_GRADER_SECRET": SECRET}
        self._folder = folder
        services, self._workers = PROCESSES[kind]
        self._stacks = [ExitStack() for _ in range(services)]
        self._running = [self._started(i) for i in range(services)]
        self.ports = [each.port for each in self._running]

    def kill_service(self, number: int) -> None:
        """Kill all processes of a service, and start it again."""
        main = self._running[number].process
        for pid in (main.pid, *self._worker_pids(number)):
            os.kill(pid, signal.SIGKILL)
        self._stacks[number].close()
        self._running[number] = self._started(number)
        self.ports[number] = self._running[number].port

    def kill_worker(self, number: int, choose: random.Random) -> None:
        running = self._running[number]
        started = running.log.count("startup complete")
        os.kill(choose.choice(self._worker_pids(number)), signal.SIGKILL)
        while running.log.count("startup complete") == started:
            time.sleep(0.02)

    def close(self) -> None:
        for each, stack in zip(self._running, self._stacks, strict=True):
            assert each.end() == 0
            stack.close()

    def _worker_pids(self, number: int) -> list[int]:
        if self._workers == 1:
            return []
        return sorted(workers(self._running[number]))

    def _started(self, number: int) -> Service:
        (folder := self._folder / f"service{number}").mkdir(exist_ok=True)
        running = self._stacks[number].enter_context(
            service(folder, "--workers", str(self._workers), **self._settings)
        )
        while running.log.count("startup complete") < self._workers:
            time.sleep(0.02)
        return running


@contextmanager
def fleet(url: str, folder: Path, kind: str) -> Iterator[Fleet]:
    made = Fleet(url, folder, kind)
    yield made
    made.close()


async def _round(fleet: Fleet, learners: Learners, number: int, choose: random.Random) -> None:
    drawn = tables(number, 0.5, (EXERCISE,))

    def hand_in(learner: str, assignment: str, i: int) -> HandIn:
        body = {"exercise": EXERCISE, **json.loads(next(drawn).content)}
        return HandIn(learner, assignment, f"{number}.{learner}.{i}", choose.uniform(0, 1), body)

    sent = [hand_in(f"greedy{number}", "limited", i) for i in range(PARALLEL)]
    sent += [hand_in(f"u{i}", "homework", i) for i in range(OTHERS)]
    everybody = asyncio.create_task(learners.all_hand_in(sent))
    await asyncio.sleep(choose.uniform(0.02, 0.9))
    if len(fleet.ports) == 1 and number % 2 == 0:
        await asyncio.to_thread(fleet.kill_worker, 0, choose)
    else:
        await asyncio.to_thread(fleet.kill_service, number % len(fleet.ports))
    await everybody


def killed(url: str, folder: Path, kind: str, rounds: int) -> tuple[Outcome, list[str]]:
    names = [f"greedy{i}" for i in range(rounds)] + [f"u{i}" for i in range(OTHERS)]
    keys, outcome, choose = enrol(url, names), Outcome(), random.Random(rounds)
    assign(url, "homework", [EXERCISE])
    assign(url, "limited", [EXERCISE], limit=LIMIT)

    async def all_rounds(running: Fleet) -> None:
        learners = Learners(running.ports, keys, outcome)
        for i in range(rounds):
            await _round(running, learners, i, choose)

    with fleet(url, folder, kind) as running:
        asyncio.run(all_rounds(running))
    broken = outcome.failures + misrecorded(url, outcome.attempts)
    counted = _counted(url, "limited")
    for i in range(rounds):
        name = f"greedy{i}"
        confirmed = sum(key.startswith(f"{i}.{name}.") for key in outcome.attempts)
        if (counted[name], confirmed) != (LIMIT, LIMIT):
            broken.append(f"{name}: {counted[name]} attempts count, {confirmed} were confirmed")
    if others := {*outcome.refused.values()} - {"no-attempts-left"}:
        broken.append(f"hand-ins were refused: {others}")
    if len(outcome.attempts) != rounds * (LIMIT + OTHERS):
        broken.append(f"{len(outcome.attempts)} hand-ins were confirmed")
    return outcome, broken


def _counted(url: str, assignment: str) -> Counter[str]:
    engine = open_database(url)
    with engine.connect() as connection:
        rows = connection.execute(
            select(attempts.c.learner)
            .join_from(attempts, assignments)
            .where(assignments.c.id == assignment, attempts.c.ordinal.is_not(None))
        )
        found = Counter(row.learner for row in rows)
    engine.dispose()
    return found
