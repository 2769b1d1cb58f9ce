"""Grade many valid and wrong tables of every robot, in random frames."""

# `python -m tests.frame_choice` runs the campaign and prints its figures. `pytest -m campaign` runs
# all of it, too; every run of pytest runs a sample (`test_properties`).

import os
import sys
import time
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

import numpy as np

from tests.frame_choice.misconceptions import MISCONCEPTIONS, named_in_all_robots
from tests.frame_choice.robots import GIVEN, POLICIES, ROBOTS, Robot, conventions
from tests.frame_choice.trials import Tally, run

TABLES = 1000
# Fewer tables under free policies, because the oracle has to search and takes long.
FREE_TABLES = 20


@dataclass(frozen=True)
class Task:
    """The tables of one robot that one process grades."""

    robot: Robot
    convention: str
    only_given: bool
    tables: int
    seed: int

    @property
    def name(self) -> str:
        return f"{self.robot.name}, {self.convention}"

    def tally(self) -> Tally:
        key = f"{self.seed} {self.robot.name} {self.convention}"
        rng = np.random.default_rng(zlib.crc32(key.encode()))
        return run(self.robot, self.convention, self.only_given, self.tables, rng)


def tasks(robots: Sequence[Robot], *, only_given: bool, tables: int, seed: int) -> list[Task]:
    """Divide the tables into tasks, one for each robot and convention."""
    policy = GIVEN if only_given else POLICIES[-1]
    return [
        Task(robot, convention, only_given, tables, seed)
        for robot in robots
        for convention in conventions(robot, policy)
    ]


def tallies(todo: Sequence[Task], jobs: int) -> list[Tally]:
    if jobs == 1:
        return list(_with_progress(todo, map(Task.tally, todo)))
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        return list(_with_progress(todo, pool.map(Task.tally, todo)))


def _with_progress(todo: Sequence[Task], found: Iterable[Tally]) -> Iterator[Tally]:
    start = time.monotonic()
    for i, (task, tally) in enumerate(zip(todo, found, strict=True), start=1):
        minutes = (time.monotonic() - start) / 60
        progress = f"{i} of {len(todo)} robots and conventions, {minutes:.1f} min ({task.name})"
        sys.stderr.write(f"\r{progress:79}")
        sys.stderr.flush()
        yield tally
    sys.stderr.write("\n")


def total(found: Sequence[Tally]) -> Tally:
    """Return the sum of all counts."""
    everything = Tally()
    for tally in found:
        everything.add(tally)
    return everything


@dataclass(frozen=True)
class Figure:
    """A fraction of tables, such as the correctly graded ones, with its lower limit."""

    name: str
    part: int
    whole: int
    least: float | None = None

    @property
    def holds(self) -> bool:
        return self.least is None or self.part >= self.least * self.whole

    def __str__(self) -> str:
        share = f"{100 * self.part / self.whole:.1f} %" if self.whole else "-"
        asked = "" if self.least is None else f"  must be {100 * self.least:.4g} %"
        return f"{self.name:66}{self.part:7} of {self.whole:6} {share:>8}{asked}" + (
            "" if self.holds else "  FAILS"
        )


# Each: the name, the counted part, the whole, and the least share. Ties are wrong cells that could
# also be repaired in another cell, so that no grader can know which was intended.
GIVEN_FIGURES = (
    ("valid tables: full marks and no error", "valid accepted", "valid", 1.0),
    ("one slip: no full marks", "slip caught", "slip", 1.0),
    ("two slips: no full marks", "two caught", "two slips", 1.0),
    ("one slip, axes not parallel: its cell alone is blamed", "skew exact", "skew", 0.98),
    ("the same without ties", "skew unshared exact", "skew unshared", 0.99),
    ("one slip, parallel axes: one row is blamed", "parallel one row", "parallel", 0.90),
    ("the same: its cell alone is blamed", "parallel exact", "parallel", None),
    ("one slip: its cell is blamed, or one that repairs as well", "as good", "slip", None),
    ("two slips: both rows are blamed", "two found", "two slips", 0.90),
    ("the same without ties", "two unshared found", "two unshared", 0.95),
    ("two slips: both rows, or cells that repair as well", "two as good", "two slips", None),
)
FREE_FIGURES = (
    ("free base, tool, directions; valid tables", "valid accepted", "valid", 1.0),
    ("free base, tool, directions; one slip: no full marks", "slip caught", "slip", 1.0),
)


def figures(given: Tally, free: Tally) -> Iterator[Figure]:
    """Yield each result of the campaign as a ``Figure``."""
    for tally, rows in ((given, GIVEN_FIGURES), (free, FREE_FIGURES)):
        for name, part, whole, least in rows:
            yield Figure(name, tally.counts[part], tally.counts[whole], least)
    both = given.counts + free.counts
    graded = both["valid"] + both["slip"] + both["two slips"]
    yield Figure("gradings without an exception", graded - both["crashed"], graded, 1.0)
    for misconception, codes in MISCONCEPTIONS:
        found = named_in_all_robots(misconception, codes)
        name = f"misconception named: {misconception.__name__.replace('_', ' ')}"
        yield Figure(name, found.named, found.total, 0.95)


def whole_campaign(
    tables: int = TABLES,
    free_tables: int = FREE_TABLES,
    seed: int = 1,
    robots: Sequence[Robot] = ROBOTS,
    jobs: int | None = None,
    show: Callable[[Task, Tally], None] = lambda _task, _tally: None,
) -> tuple[Tally, Tally]:
    found = []
    for only_given, count in ((True, tables), (False, free_tables)):
        todo = tasks(robots, only_given=only_given, tables=count, seed=seed)
        each = tallies(todo, jobs or os.cpu_count() or 1)
        for task, tally in zip(todo, each, strict=True):
            show(task, tally)
        found.append(total(each))
    return found[0], found[1]
