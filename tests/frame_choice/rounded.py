"""``python -m tests.frame_choice.rounded --robots N``: grade tables with rounded numbers."""

# Write the tables of random robots in random frames with three to six digits. These tables must get
# full marks. A table with one changed digit must not get them. An exception is a digit that does
# not matter: there are exact numbers that make the table valid, and rounded or cut off they give
# all its decimals.

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from tests.frame_choice import oracle
from tests.frame_choice.by_policy import described, full_marks
from tests.frame_choice.cells import Cell
from tests.frame_choice.generator import Table, reassignment
from tests.frame_choice.kinematics import Numbers, cell_values
from tests.frame_choice.robots import ALPHA, POLICIES, THETA, Policy, Robot, conventions, exercise
from tests.frame_choice.trials import CrashError, equivalent, graded
from tests.frame_choice.unseen import random_robot

FIGURES = (3, 4, 5, 6)
CHANGED_BY = 3
ROUNDED_UP, CUT_OFF = 0.5, 1.0
# A remaining error above this share of the error of one unit shows a wrong digit.
CLEARLY = 0.1
# An error below this share of the error of one unit comes from the oracle itself.
NO_EFFECT = 1e-3


@dataclass(frozen=True)
class RoundedCell(Cell):
    """A table cell whose constant is a rounded decimal."""

    figures: int = 3
    units: int = 0  # added in the last place

    @property
    def unit(self) -> float:
        # The value of one unit in the last place, or 0 if the cell has no constant.
        if not self.constant:
            return 0.0
        return float(10.0 ** (np.floor(np.log10(abs(self.constant))) + 1 - self.figures))

    @property
    def text(self) -> str:
        rest = replace(self, constant=0.0)
        formula = "" if rest.is_zero else Cell.text.fget(rest)  # type: ignore[attr-defined]
        if not self.constant:
            return formula or "0"
        number = round(self.constant / self.unit) + self.units
        places = max(0, -round(np.log10(self.unit)))
        digits = f"{abs(number) * self.unit:.{places}f}"
        if not formula:
            return digits if number >= 0 else f"-{digits}"
        return f"{formula} {'+' if number >= 0 else '-'} {digits}"


def with_odd_angles(robot: Robot, rng: np.random.Generator) -> Robot:
    def odd(text: str, column: int) -> str:
        if column not in (ALPHA, THETA) or text == "0" or text in robot.joints:
            return text
        variable = text.split("+")[0] if text.startswith("q") else ""
        if rng.random() < 0.3:
            return text
        angle = f"{rng.uniform(0.2, 2.9):.{rng.integers(2, 6)}f}"
        return f"{variable}+{angle}" if variable else angle

    rows = tuple(tuple(odd(text, i) for i, text in enumerate(row)) for row in robot.rows)
    return replace(robot, rows=rows, name=f"{robot.name}, odd")  # type: ignore[arg-type]


def rounded(table: Table, figures: int) -> Table:
    """Return the table with its constants rounded to ``figures`` significant digits."""
    rows = tuple(
        tuple(RoundedCell(**vars(cell), figures=figures) for cell in row) for row in table.rows
    )
    return replace(table, rows=rows)  # type: ignore[arg-type]


def changed(table: Table, rng: np.random.Generator) -> tuple[Table, tuple[int, int]] | None:
    """Return the table with the last digit of one constant changed."""
    # Return None if the table has no constant, or if it contains a root or an arc tangent.
    if any(cell.terms for row in table.rows for cell in row):
        return None
    places = [
        (i, j) for i, row in enumerate(table.rows) for j, cell in enumerate(row) if cell.constant
    ]
    if not places:
        return None
    row, column = places[rng.integers(len(places))]
    cell = table.rows[row][column]
    assert isinstance(cell, RoundedCell)
    other = replace(cell, units=int(CHANGED_BY * rng.choice([-1, 1])))
    return table.edited(row, column, other), (row, column)


def _matters(other: Table, printed: Table) -> bool:
    # True if rounding explains the table `printed`, but not `other` with a changed digit.
    return least_error(other) > CLEARLY and least_error(printed) < CLEARLY / 10


def least_error(table: Table) -> float:
    # Return how far the pose is from a valid one if rounding explains as much as it can.
    #
    # The table's decimals may come from any numbers that round to them; the closest are taken. An
    # error of 1 is the smallest effect of one unit in the last place of a decimal.
    cells = [
        (i, j, cell)
        for i, row in enumerate(table.rows)
        for j, cell in enumerate(row)
        if isinstance(cell, RoundedCell) and cell.constant
    ]

    def error(moves: Numbers) -> Numbers:
        def table_of(values: object) -> Numbers:
            found = cell_values(table.texts, values)  # type: ignore[arg-type]
            for (i, j, cell), move in zip(cells, moves, strict=True):
                found[i, j] += move * cell.unit
            return found

        return oracle.difference(table.robot, table.policy, table_of, table.convention).ravel()

    start = error(np.zeros(len(cells)))
    if np.abs(start).max() > 1:
        return np.inf
    rates = np.array([(error(way / 4) - error(-way / 4)) * 2 for way in np.eye(len(cells))])
    signs = np.array(
        [1 if round(cell.constant / cell.unit) + cell.units >= 0 else -1 for *_, cell in cells]
    )
    low = np.where(signs > 0, -ROUNDED_UP, -CUT_OFF)
    high = np.where(signs > 0, CUT_OFF, ROUNDED_UP)
    sizes = (rates * rates).sum(axis=1)
    sizes[sizes < [(NO_EFFECT * cell.unit) ** 2 for *_, cell in cells]] = 0.0
    moves, left = np.zeros(len(cells)), start.copy()
    for _ in range(2000):
        for k in range(len(cells)):
            if not sizes[k]:
                continue
            to = np.clip(moves[k] - rates[k] @ left / sizes[k], low[k], high[k])
            left += (to - moves[k]) * rates[k]
            moves[k] = to
    smallest = np.sqrt(sizes[sizes > 0].min(initial=np.inf))
    return float(np.linalg.norm(left) / smallest)


@dataclass
class RoundedCounts:
    """Counts of graded tables, and the tables that were graded wrongly."""

    counts: Counter[str] = field(default_factory=Counter)
    misses: list[str] = field(default_factory=list)

    def judge(self, table: Table, kind: str, *, right: bool, seeds: int) -> None:
        self.counts[kind] += 1
        try:
            is_right = graded(table).full_marks
        except CrashError as error:
            self.misses.append(f"{kind}, {error.__cause__!r}: {described(table)}")
            return
        if is_right != right:
            self.counts[f"{kind} misjudged"] += 1
            self.misses.append(f"{kind}: {described(table)}")
        elif any(full_marks(table, seed) != right for seed in range(seeds)):
            self.counts[f"{kind} changed by the samples"] += 1
            self.misses.append(f"{kind} changed by the samples: {described(table)}")


def tables(
    numbers: Iterable[int], seed: int, policies: tuple[Policy, ...]
) -> Iterator[tuple[Table, np.random.Generator]]:
    """Yield valid tables in random frames."""
    for number in numbers:
        rng = np.random.default_rng([seed, number])
        robot = with_odd_angles(random_robot(number, rng), rng)
        for policy in policies:
            for convention in conventions(robot, policy):
                try:
                    table, _ = reassignment(robot, policy, convention, rng)
                except RuntimeError:  # its numbers cannot be written as formulas
                    continue
                if equivalent(table):
                    yield table, rng


def run(
    numbers: Iterable[int], seed: int, seeds: int = 0, policies: tuple[Policy, ...] = POLICIES
) -> RoundedCounts:
    found = RoundedCounts()
    for table, rng in tables(numbers, seed, policies):
        figures = int(rng.choice(FIGURES))
        printed = rounded(table, figures)
        found.judge(printed, f"{figures} figures, {table.policy.name}", right=True, seeds=seeds)
        edit = changed(printed, rng)
        ends = table.policy.base and table.policy.tool
        # With two free ends, the oracle uses finite differences, too coarse for a last digit.
        if edit is not None and not ends and _matters(edit[0], printed):
            found.judge(edit[0], f"changed, {table.policy.name}", right=False, seeds=seeds)
        for cached in (exercise, oracle.samples, oracle.reference_poses):
            cached.cache_clear()
    return found


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice.rounded")
    parser.add_argument("--robots", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=0, help="sets of samples for each table")
    parser.add_argument("--misses", type=int, default=5, help="misses to print")
    parser.add_argument("--policies", type=int, default=len(POLICIES), help="number of policies")
    options = parser.parse_args()
    numbers = range(options.first, options.first + options.robots)
    found = run(numbers, options.seed, options.seeds, POLICIES[: options.policies])
    counts = [f"{count:6} {kind}" for kind, count in sorted(found.counts.items())]
    sys.stdout.write("\n".join([*counts, "", *sorted(found.misses)[: options.misses]]) + "\n")
    return 1 if found.misses else 0


if __name__ == "__main__":
    sys.exit(main())
