"""``python -m tests.frame_choice.by_policy --robots N``: unseen robots under the eight policies.

Under each policy, and in each convention, tables of random robots are drawn: valid ones must get
full marks, ones with a slip must not, and no verdict may depend on the draw of the samples.
"""

import argparse
import os
import sys
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from multiprocessing import get_context

import numpy as np

from tests.frame_choice import oracle
from tests.frame_choice.generator import Table, reassignment
from tests.frame_choice.robots import POLICIES, Policy, conventions, exercise
from tests.frame_choice.trials import CrashError, equivalent, grade_rows, graded, one_slip
from tests.frame_choice.unseen import random_robot

SEEDS = 20
VALID, WRONG = "valid", "wrong"
MISJUDGED, EXACT, UNSTEADY = "misjudged", "blamed on its cell", "changed by the draw"


@dataclass
class Counts:
    """Counts by policy, truth and what was said; ``misses`` are tables that were misjudged."""

    counts: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    misses: list[str] = field(default_factory=list)

    def add(self, other: "Counts") -> None:
        self.counts += other.counts
        self.misses += other.misses

    def of(self, truth: str, said: str = "", policy: str | None = None) -> int:
        """How many of the tables ``truth`` is true of were ``said`` something of."""
        return sum(
            count
            for (name, its_truth, told), count in self.counts.items()
            if (its_truth, told) == (truth, said) and policy in (None, name)
        )

    def judge(self, table: Table, truth: str, seeds: int, note: str = "") -> None:
        """Grade a table, and count what is said of it."""

        def count(said: str) -> None:
            self.counts[table.policy.name, truth, said] += 1

        def miss(said: str) -> None:
            count(said)
            self.misses.append(f"{truth}, {said}: {described(table)}{note}")

        count("")
        try:
            found = graded(table)
        except CrashError as error:
            miss(f"{MISJUDGED} ({error.__cause__!r})")
            return
        if found.full_marks != (truth == VALID) or (truth == VALID and not found.is_clean):
            miss(MISJUDGED)
        elif {full_marks(table, seed) for seed in range(seeds)} - {found.full_marks}:
            miss(UNSTEADY)
        if truth == WRONG and note and found.blamed == {_place_of(note)}:
            count(EXACT)


def _place_of(note: str) -> tuple[int, int]:
    row, column = note.rsplit("@", 1)[1].split(",")
    return int(row), int(column)


def full_marks(table: Table, seed: int) -> bool:
    """Whether the table gets full marks in another draw of the samples."""
    compiled = exercise(table.robot, table.policy)
    redrawn = replace(compiled, version=f"{compiled.version} {seed}")
    report = grade_rows(redrawn, table.texts, table.convention)
    return bool(report.points == report.max_points)


def described(table: Table) -> str:
    """Robot, policy and table, to be pasted into a test."""
    robot = table.robot
    lines = [
        f"{robot.name} {robot.structure}, {robot.convention}; {table.policy.name}",
        *(f"    {' | '.join(row)}" for row in robot.rows),
        f"  in the {table.convention} convention",
        *(f"    {' | '.join(row)}" for row in table.texts),
    ]
    return "\n".join(lines) + "\n"


def run(
    numbers: Iterable[int], seed: int, seeds: int, policies: tuple[Policy, ...] = POLICIES
) -> Counts:
    """The counts for the robots of these numbers: two tables for each policy and convention."""
    counts = Counts()
    for number in numbers:
        rng = np.random.default_rng([seed, number])
        robot = random_robot(number, rng)
        for policy in policies:
            for convention in conventions(robot, policy):
                try:
                    table, _ = reassignment(robot, policy, convention, rng)
                except RuntimeError:  # its numbers are no formulas
                    continue
                if not equivalent(table):
                    raise AssertionError(f"the generator drew a wrong table: {described(table)}")
                counts.judge(table, VALID, seeds)
                edit = one_slip(table, rng)
                if edit is not None:
                    wrong = table.edited(edit.row, edit.column, edit.cell)
                    counts.judge(wrong, WRONG, seeds, f"{edit} @{edit.row},{edit.column}")
        for cached in (exercise, oracle.samples, oracle.reference_poses):
            cached.cache_clear()
    return counts


def _task(task: tuple[range, int, int]) -> Counts:
    return run(*task)


def lines(found: Counts) -> list[str]:
    """The figures by policy, and of all."""
    table = []
    for policy in (*(policy.name for policy in POLICIES), None):
        cells = [f"{policy or 'all':24}"]
        for truth, more in ((VALID, ()), (WRONG, (EXACT,))):
            cells.append(f"{found.of(truth, '', policy):7} {truth}")
            cells += [f"{found.of(truth, said, policy):5} {said}" for said in (MISJUDGED, UNSTEADY)]
            for said in more:
                share = found.of(truth, said, policy) / max(1, found.of(truth, "", policy))
                cells.append(f"{100 * share:6.1f} % {said}")
        table.append(",".join(cells))
    return table


def main() -> int:
    """Run and print; 1 if a table was misjudged."""
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice.by_policy")
    parser.add_argument("--robots", type=int, default=700)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=SEEDS, help="draws of each table")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--misses", type=int, default=5, help="print so many")
    options = parser.parse_args()
    size = 10
    tasks = [
        (range(first, min(first + size, options.robots)), options.seed, options.seeds)
        for first in range(0, options.robots, size)
    ]
    total = Counts()
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        for found in pool.map(_task, tasks):
            total.add(found)
    shown = "\n".join([*lines(total), "", *total.misses[: options.misses]])
    sys.stdout.write(f"{shown}\n")
    return 1 if total.misses else 0


if __name__ == "__main__":
    sys.exit(main())
