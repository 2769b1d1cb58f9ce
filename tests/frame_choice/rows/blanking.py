"""``python -m tests.frame_choice.rows.blanking --tries 20000``: test that empty cells are fair.

A wrong table should not earn more after a row or a cell was emptied.
"""

# An empty cell does raise the points in a few tables with several wrong rows. In these tables, it
# leads the grader to another interpretation of the other rows, which earns more.

import argparse
import os
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from multiprocessing import get_context

import numpy as np
from dh_grader.grading import PartReport, Verdict

from tests.frame_choice import misconceptions
from tests.frame_choice.generator import reassignment
from tests.frame_choice.robots import POLICIES, Policy, Robot, conventions, exercise
from tests.frame_choice.rows.one_row import UNSEEN, all_robots
from tests.frame_choice.rows.student_rows import StudentRowsTexts as Texts
from tests.frame_choice.rows.student_rows import shipped_robots, wrong_row
from tests.frame_choice.trials import grade_rows

# The largest share of tries that may raise the points; the aim is 0.
MOST = 0.002
# Tolerance for points that are rounded to hundredths.
DUST = 1e-9
PLACES = 4

SYSTEMATIC = (
    misconceptions.degrees_everywhere,
    misconceptions.columns_shifted,
    misconceptions.a_and_d_swapped,
    misconceptions.alpha_and_theta_swapped,
    misconceptions.rows_exchanged,
    misconceptions.column_signs,
)


@dataclass
class Found:
    """Counts how often emptying cells raised the points."""

    tries: Counter[str] = field(default_factory=Counter)
    gains: Counter[str] = field(default_factory=Counter)
    misses: list[str] = field(default_factory=list)

    def add(self, other: "Found") -> None:
        self.tries += other.tries
        self.gains += other.gains
        self.misses += other.misses


def spoiled(robot: Robot, texts: Texts, rng: np.random.Generator) -> Iterator[tuple[str, Texts]]:
    """Yield wrong tables, each with the name of its mistake."""
    rows = len(texts)
    for count in (1, 2, 3, 4):
        one = wrong_row(robot, texts, int(rng.integers(rows)), count, rng)
        if one is not None:
            yield f"one row, {count}", one
    for places in (2, 3, 5):
        spread: Texts | None = texts
        for _ in range(places):
            spread = spread and wrong_row(robot, spread, int(rng.integers(rows)), 1, rng)
        if spread is not None:
            yield f"{places} cells anywhere", spread
    two: Texts | None = texts
    for row in rng.permutation(rows)[:2].tolist():
        two = two and wrong_row(robot, two, row, 3 + int(rng.integers(2)), rng)
    if two is not None:
        yield "two rows", two
    zeros = rng.random((rows, 4)) < rng.choice([0.3, 0.6])
    yield (
        "zeros anywhere",
        [["0" if zeros[i, j] else texts[i][j] for j in range(4)] for i in range(rows)],
    )
    plain = [(a, alpha, d, theta) for a, alpha, d, theta in texts]
    misconception = SYSTEMATIC[int(rng.integers(len(SYSTEMATIC)))]
    for wrong in list(misconception(robot, plain))[:1]:
        yield "throughout", [list(row) for row in wrong]
        more = wrong_row(robot, [list(row) for row in wrong], int(rng.integers(rows)), 1, rng)
        if more is not None:
            yield "throughout, and a slip", more


def judge(
    found: Found,
    sort: str,
    robot: Robot,
    policy: Policy,
    name: str,
    texts: Texts,
    rng: np.random.Generator,
) -> None:
    compiled = exercise(robot, policy)
    written = grade_rows(compiled, texts, name)
    for row, columns in places(written, len(texts), rng):
        empty = [
            ["" if i == row and j in columns else text for j, text in enumerate(cells)]
            for i, cells in enumerate(texts)
        ]
        report = grade_rows(compiled, empty, name)
        what = f"{sort}; {'row' if len(columns) > 1 else 'cell'}"
        found.tries[what] += 1
        if report.points > written.points + DUST:
            found.gains[what] += 1
            found.misses.append(described(what, robot, policy, name, empty, texts, report, written))


def places(
    report: PartReport, rows: int, rng: np.random.Generator
) -> Iterator[tuple[int, Sequence[int]]]:
    blamed = [
        (i, j)
        for i, row in enumerate(report.rows)
        for j, cell in enumerate(row.cells)
        if cell.verdict is not Verdict.CORRECT and i < rows
    ]
    anywhere = [(i, j) for i in range(rows) for j in range(4)]
    for chosen in (blamed or anywhere, anywhere):
        yield chosen[int(rng.integers(len(chosen)))][0], range(4)
        for _ in range(PLACES // 2):
            row, column = chosen[int(rng.integers(len(chosen)))]
            yield row, [column]


def described(
    what: str,
    robot: Robot,
    policy: Policy,
    name: str,
    empty: Texts,
    texts: Texts,
    report: PartReport,
    written: PartReport,
) -> str:
    pairs = zip(texts, empty, strict=True)
    return "\n".join(
        [
            f"{what}: {written.points} written, {report.points} empty of {report.max_points}",
            f"  {robot.name} {robot.structure} {robot.convention}; {policy.name}",
            *(f"    {' | '.join(row)}" for row in robot.rows),
            f"  in the {name} convention",
            *(
                "    " + " | ".join(t if e else f"[{t}]" for t, e in zip(one, other, strict=True))
                for one, other in pairs
            ),
        ]
    )


def run(
    numbers: Sequence[int],
    tries: int,
    seed: int,
    unseen: int = UNSEEN,
    policies: Sequence[Policy] = POLICIES,
) -> Found:
    found = Found()
    for number in numbers:
        robot, rng = all_robots(unseen, seed)[number], np.random.default_rng([seed, number, 2])
        enough, failed = found.tries.total() + tries, 0
        while found.tries.total() < enough and failed < 10:
            # In half of the tables, base, tool and directions are given.
            chosen = policies[0 if rng.random() < 0.5 else int(rng.integers(len(policies)))]
            names = conventions(robot, chosen)
            name = names[int(rng.integers(len(names)))]
            try:
                boldness = 0.0 if rng.random() < 0.5 else None
                texts = reassignment(robot, chosen, name, rng, boldness)[0].texts
            except RuntimeError:  # its numbers are no formulas
                failed += 1
                continue
            for sort, wrong in spoiled(robot, texts, rng):
                if found.tries.total() < enough:
                    judge(found, sort, robot, chosen, name, wrong, rng)
    return found


def _task(task: tuple[Sequence[int], int, int, int]) -> Found:
    return run(*task)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice.rows.blanking")
    parser.add_argument("--tries", type=int, default=20_000)
    parser.add_argument("--unseen", type=int, default=UNSEEN, help="random robots")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--misses", type=int, default=5, help="misses to print")
    options = parser.parse_args()
    robots = len(shipped_robots()) + options.unseen
    each = -(-options.tries // robots)
    tasks = [([number], each, options.seed, options.unseen) for number in range(robots)]
    found = Found()
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        for result in pool.map(_task, tasks, chunksize=4):
            found.add(result)
    counted = [f"{sort}: {found.gains[sort]} of {n}" for sort, n in sorted(found.tries.items())]
    gained = f"gained by an empty place: {found.gains.total()} of {found.tries.total()}"
    shown = "\n".join([*found.misses[: options.misses], "", *counted, gained])
    sys.stdout.write(f"{shown}\n")
    return int(found.gains.total() > MOST * found.tries.total())


if __name__ == "__main__":
    sys.exit(main())
