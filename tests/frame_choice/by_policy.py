"""``python -m tests.frame_choice.by_policy --robots N``: grade tables of random robots.

A policy says which frames and joint directions a student may choose. The program grades tables
under all eight policies.
"""

# A valid table must get full marks, and a table with a wrong cell must not. No verdict may depend
# on the random numbers at which the grader compares poses.

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
from tests.frame_choice.edits import Edit
from tests.frame_choice.generator import Table, reassignment
from tests.frame_choice.robots import POLICIES, Policy, conventions, exercise
from tests.frame_choice.trials import CrashError, equivalent, grade_rows, graded, one_slip
from tests.frame_choice.unseen import random_robot

SEEDS = 20
VALID, WRONG = "valid", "wrong"
MISJUDGED, EXACT, UNSTEADY = "misjudged", "blamed on its cell", "changed by the samples"


@dataclass
class Counts:
    """Counts of graded tables, and the tables that were graded wrongly."""

    counts: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    misses: list[str] = field(default_factory=list)

    def add(self, other: "Counts") -> None:
        self.counts += other.counts
        self.misses += other.misses

    def of(self, truth: str, said: str = "", policy: str | None = None) -> int:
        return sum(
            count
            for (name, its_truth, told), count in self.counts.items()
            if (its_truth, told) == (truth, said) and policy in (None, name)
        )

    def judge(self, table: Table, edit: Edit | None, seeds: int) -> None:
        truth = WRONG if edit else VALID

        def count(said: str) -> None:
            self.counts[table.policy.name, truth, said] += 1
            if said in (MISJUDGED, UNSTEADY):
                self.misses.append(f"{truth}, {said}: {described(table)}  {edit or ''}")

        count("")
        try:
            found = graded(table)
        except CrashError:
            count(MISJUDGED)
            return
        if found.full_marks if edit else not (found.full_marks and found.is_clean):
            count(MISJUDGED)
        elif {full_marks(table, seed) for seed in range(seeds)} - {found.full_marks}:
            count(UNSTEADY)
        if edit and found.blamed == {(edit.row, edit.column)}:
            count(EXACT)


def full_marks(table: Table, seed: int) -> bool:
    """True if the table gets full marks."""
    compiled = exercise(table.robot, table.policy)
    redrawn = replace(compiled, version=f"{compiled.version} {seed}")
    report = grade_rows(redrawn, table.texts, table.convention)
    return bool(report.points == report.max_points)


def described(table: Table) -> str:
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
    counts = Counts()
    for number in numbers:
        rng = np.random.default_rng([seed, number])
        robot = random_robot(number, rng)
        for policy in policies:
            for convention in conventions(robot, policy):
                try:
                    table, _ = reassignment(robot, policy, convention, rng)
                except RuntimeError:  # its numbers cannot be written as formulas
                    continue
                if not equivalent(table):
                    raise AssertionError(f"the generator drew a wrong table: {described(table)}")
                counts.judge(table, None, seeds)
                edit = one_slip(table, rng)
                if edit is not None:
                    wrong = table.edited(edit.row, edit.column, edit.cell)
                    counts.judge(wrong, edit, seeds)
        for cached in (exercise, oracle.samples, oracle.reference_poses):
            cached.cache_clear()
    return counts


def _task(task: tuple[range, int, int]) -> Counts:
    return run(*task)


def lines(found: Counts) -> list[str]:
    """Return the results as lines of text."""
    said = [(VALID, ""), (VALID, MISJUDGED), (VALID, UNSTEADY)]
    said += [(WRONG, ""), (WRONG, MISJUDGED), (WRONG, UNSTEADY), (WRONG, EXACT)]
    head = "".join(f"{told or truth:>20}" for truth, told in said)
    table = [f"{'':24}{head}"]
    for policy in (*(policy.name for policy in POLICIES), None):
        cells = "".join(f"{found.of(truth, told, policy):20}" for truth, told in said)
        table.append(f"{policy or 'all':24}{cells}")
    return table


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice.by_policy")
    parser.add_argument("--robots", type=int, default=700)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=SEEDS, help="sets of samples for each table")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--misses", type=int, default=5, help="misses to print")
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
