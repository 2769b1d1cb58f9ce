"""``python -m tests.frame_choice.rows.one_row --tables 5000``: grade tables with one wrong row."""

# One row of a valid table is wrong in one to four cells, as students write them. The correct cells
# of the other rows must stay correct, and the report must not praise frames that only the wrong row
# implies. The grader may mark other cells as wrong if these are fewer, or equally many in another
# row, and if other values in them make the table valid. A table gets full marks only if it is
# valid, or if its decimals may be rounded from the numbers of a valid table (see `true_numbers`).

import argparse
import os
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from multiprocessing import get_context

import numpy as np
from dh_grader.grading import PartReport, Verdict

from tests.frame_choice.generator import reassignment
from tests.frame_choice.oracle import is_equivalent
from tests.frame_choice.repairs import Place, can_repair
from tests.frame_choice.robots import (
    COLUMNS,
    GIVEN,
    POLICIES,
    Policy,
    Robot,
    conventions,
    exercise,
)
from tests.frame_choice.rows.student_rows import StudentRowsTexts as Texts
from tests.frame_choice.rows.student_rows import is_valid_when_rounded, shipped_robots, wrong_row
from tests.frame_choice.trials import grade_rows
from tests.frame_choice.unseen import random_robot

UNSEEN = 100
MOST = 0.005
PRAISE = "own_frame_choice"


@dataclass(frozen=True)
class WrongRow:
    """A table with ``count`` wrong cells in one row."""

    # `valid` is the correct table; `usual` is True if it has the same frames as the reference.
    robot: Robot
    policy: Policy
    convention: str
    valid: Texts
    texts: Texts
    row: int
    count: int
    usual: bool

    def __str__(self) -> str:
        robot = self.robot
        return "\n".join(
            [
                f"{robot.name} {robot.structure} {robot.convention}; {self.policy.name}",
                *(f"    {' | '.join(row)}" for row in robot.rows),
                f"  {self.convention}, row {self.row + 1} wrong in {self.count}",
                *(f"    {' | '.join(row)}" for row in self.texts),
            ]
        )


@dataclass
class Found:
    """Counts of correctly and wrongly graded tables."""

    counts: Counter[str] = field(default_factory=Counter)
    misses: list[str] = field(default_factory=list)

    def add(self, other: "Found") -> None:
        self.counts += other.counts
        self.misses += other.misses

    def judge(self, table: WrongRow) -> None:
        compiled = exercise(table.robot, table.policy)
        report = grade_rows(compiled, table.texts, table.convention)
        name = f"{'usual' if table.usual else 'own'} frames, {table.count} wrong"
        self.counts[name] += 1
        if report.points == report.max_points:
            if is_valid_when_rounded(table.robot, table.policy, table.texts, table.convention):
                self.counts[f"{name}: valid when rounded"] += 1
                return
            self.counts[f"{name}: accepted"] += 1
            self.misses.append(f"accepted: {table}")
        blamed = blamed_cells(report, table)
        others = {(i, j) for i, j in blamed if i != table.row and i < len(table.texts)}
        if not others:
            valid = grade_rows(compiled, table.valid, table.convention)
            if praises(report) - praises(valid):
                self.counts[f"{name}: praised"] += 1
                self.misses.append(f"praised: {table}")
            return
        tie = is_as_good(table, blamed)
        self.counts[f"{name}: {'tie' if tie else 'reddened'}"] += 1
        if not tie:
            places = [f"{row + 1} {COLUMNS[column]}" for row, column in sorted(blamed)]
            self.misses.append(f"reddened ({', '.join(places)}): {table}")


def praises(report: PartReport) -> set[str]:
    return {message.message for message in report.feedback if message.code == PRAISE}


def blamed_cells(report: PartReport, table: WrongRow) -> set[Place]:
    # Return the cells that are marked as wrong, or {(-1, -1)} if the grader reordered rows.
    labels = [row.label for row in report.rows]
    if table.robot.labels(len(labels)) != labels:
        return {(-1, -1)}
    return {
        (i, column)
        for i, row in enumerate(report.rows)
        for column, cell in enumerate(row.cells)
        if cell.verdict is not Verdict.CORRECT
    }


def is_as_good(table: WrongRow, blamed: set[Place]) -> bool:
    # True if the report marks few enough cells as wrong, and new values in them repair the table.
    #
    # `blamed` are these cells. They must be fewer than the cells that are really wrong. An equal
    # number is allowed if they are all in one row, or if the table has the student's own frames.
    rows = {row for row, _ in blamed}
    most = table.count - (len(rows) > 1 and table.usual)
    if not 0 < len(blamed) <= most or min(rows) < 0 or max(rows) >= len(table.texts):
        return False
    return can_repair(table.robot, table.policy, table.texts, table.convention, sorted(blamed))


def tables(
    robot: Robot, policies: Sequence[Policy], rng: np.random.Generator
) -> Iterator[WrongRow]:
    kinds = [
        (policy, convention, boldness)
        for policy in policies
        for convention in conventions(robot, policy)
        for boldness in (0.0, None)
    ]
    for i in range(10**9):
        policy, convention, boldness = kinds[i % len(kinds)]
        try:
            valid = reassignment(robot, policy, convention, rng, boldness)[0].texts
        except RuntimeError:  # its numbers are no formulas
            if i > 100 * len(kinds):
                return
            continue
        row, count = int(rng.integers(len(valid))), 1 + i // len(kinds) % 4
        spoiled = wrong_row(robot, valid, row, count, rng)
        if spoiled is not None and not is_equivalent(robot, policy, spoiled, convention):
            yield WrongRow(robot, policy, convention, valid, spoiled, row, count, boldness == 0.0)


@cache
def all_robots(unseen: int, seed: int) -> tuple[Robot, ...]:
    """Return the robots of the shipped exercises, and random ones."""
    drawn = (random_robot(i, np.random.default_rng([seed, i])) for i in range(unseen))
    return (*shipped_robots(), *drawn)


def run(
    numbers: Sequence[int],
    count: int,
    seed: int,
    unseen: int = UNSEEN,
    policies: Sequence[Policy] = (GIVEN,),
) -> Found:
    found = Found()
    for number in numbers:
        robot = all_robots(unseen, seed)[number]
        drawn = tables(robot, policies, np.random.default_rng([seed, number, 1]))
        for _, table in zip(range(count), drawn, strict=False):
            found.judge(table)
    return found


def _task(task: tuple[Sequence[int], int, int, int, Sequence[Policy]]) -> Found:
    return run(*task)


def total(found: Found, said: str) -> int:
    return sum(
        count
        for name, count in found.counts.items()
        if (name.endswith(f": {said}") if said else ":" not in name)
    )


def lines(found: Found) -> list[str]:
    """Return the results as lines of text."""
    graded, told = total(found, ""), [f"{name}: {n}" for name, n in sorted(found.counts.items())]
    for said, most in (("accepted", 0.0), ("reddened", MOST), ("praised", MOST)):
        count = total(found, said)
        share = f"{100 * count / max(graded, 1):.2f} %, at most {100 * most} %"
        verdict = "" if count <= most * graded else "  FAILS"
        told.append(f"{said}: {count} of {graded}, {share}{verdict}")
    return told


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice.rows.one_row")
    parser.add_argument("--tables", type=int, default=5000)
    parser.add_argument("--unseen", type=int, default=UNSEEN, help="random robots")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--misses", type=int, default=5, help="misses to print")
    parser.add_argument("--policies", type=int, default=1, help="number of policies")
    options = parser.parse_args()
    policies = POLICIES[: options.policies]
    shipped = len(shipped_robots())
    # Half of the tables are of shipped exercises.
    of_shipped = -(-options.tables // (2 * shipped))
    of_unseen = -(-options.tables // (2 * max(options.unseen, 1)))
    tasks = [
        (
            [number],
            of_shipped if number < shipped else of_unseen,
            options.seed,
            options.unseen,
            policies,
        )
        for number in range(shipped + options.unseen)
    ]
    found = Found()
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        for each in pool.map(_task, tasks, chunksize=4):
            found.add(each)
    shown = "\n".join([*found.misses[: options.misses], "", *lines(found)])
    sys.stdout.write(f"{shown}\n")
    return int(any(line.endswith("FAILS") for line in lines(found)))


if __name__ == "__main__":
    sys.exit(main())
