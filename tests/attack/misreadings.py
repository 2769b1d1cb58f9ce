"""`python -m tests.attack.misreadings`: test if the program misreads formulas.

Write random formulas in many notations, and compare how the program reads them with their true
values. Exit with 1 if the program misreads a formula, or refuses too many.
"""

# Write each random formula in every spelling, and matrices of formulas in every grid format. The
# program must read the value that an oracle of the tests computes, or refuse the text. An answer
# must get the same verdicts and points in every spelling, and an entry with a changed sign must be
# wrong.

import argparse
import sys
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from random import Random
from typing import Final

import numpy as np
from dh_grader.expressions import ExpressionError, read
from dh_grader.pasting import GridError, read_grid

from tests.attack import graded
from tests.attack.formulas import (
    TURNING,
    Tree,
    Values,
    angle,
    evaluated,
    formula,
    numbers,
)
from tests.attack.spellings import OPEN, SPELLINGS, Spelling, Writer
from tests.expressions.corpus_files import ROBOT
from tests.pasting.writers import FORMATS

# The largest share of texts that may be refused, in each spelling and in each format.
REFUSED: Final = 0.02
# Grids in which blanks may separate the cells, and those in LaTeX.
BLANKS: Final = frozenset({
    "columns", "one blank", "MATLAB", "MATLAB with blanks", "MATLAB with lines",
    "MATLAB without brackets", "MATLAB print", "array print",
})  # fmt: skip
LATEX: Final = frozenset({"LaTeX tabular", "LaTeX booktabs", "bmatrix", "pmatrix", "matrix",
                          "smallmatrix", "bmatrix*", "array", "LaTeX rows"})  # fmt: skip
TIGHT: Final = tuple(
    replace(SPELLINGS[name], blanks=("",), times=("*",), turns=("pi", "deg"), around=("{}",))
    for name in ("plain", "Python", "Greek", "shorthand")
)
_CANONICAL: Final = {f"q{index}": f"theta{index}" for index in TURNING} | {"q3": "d3"}


@dataclass
class Tally:
    """Counts how often texts in each notation were read or misread."""

    outcomes: dict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    misread: list[str] = field(default_factory=list)

    def add(self, name: str, outcome: str, text: str = "") -> None:
        self.outcomes[name][outcome] += 1
        if outcome == "misread":
            self.misread.append(f"{name}: {text}")

    def refused(self, name: str) -> float:
        counted = self.outcomes[name]
        return counted.total() and 1 - counted["read"] / counted.total()


def is_steady(tree: Tree, values: dict[str, Values]) -> bool:
    found = evaluated(tree, values)
    near = evaluated(tree, {name: each * (1 + 1e-12) for name, each in values.items()})
    return bool(np.all(np.isfinite(found)) and np.all(np.abs(found) < 1e9)) and bool(
        np.allclose(found, near, rtol=1e-9, atol=1e-9)
    )


def drawn(random: Random, depth: int = 2) -> tuple[Tree, dict[str, Values]]:
    while True:
        tree = angle(random) if random.random() < 0.1 else formula(random, depth)
        values = numbers(random)
        if is_steady(tree, values):
            return tree, values


def outcome(text: str, tree: Tree, values: dict[str, Values], *, degrees: bool) -> str:
    try:
        expression = read(text, ROBOT, angle_unit="degrees" if degrees else "radians")
    except ExpressionError as error:
        return f"refused: {error.code}"
    named = {_CANONICAL.get(name, name): value for name, value in values.items()}
    found = np.broadcast_to(expression.evaluate(named), len(values["k"]))
    same = np.allclose(found, evaluated(tree, values), rtol=1e-7, atol=1e-8)
    return "read" if same else "misread"


def entries(count: int, seed: str) -> Iterator[tuple[str, str, str]]:
    """Write random formulas in every notation; yield notation, outcome and text."""
    for number in range(count):
        random = Random(f"{seed}.{number}")
        tree, values = drawn(random)
        for name, spelling in SPELLINGS.items():
            text = Writer(spelling, random).write(tree)
            yield name, outcome(text, tree, values, degrees=spelling.degrees), text


def suited(name: str, random: Random) -> Spelling:
    if name in BLANKS:
        return random.choice(TIGHT)
    closed = [each for each in SPELLINGS if each not in OPEN]
    if name in LATEX and random.random() < 0.7:
        closed = [each for each in closed if "LaTeX" in each]
    elif name not in LATEX:
        # A backslash and a bar have other meanings there.
        closed = [each for each in closed if "LaTeX" not in each]
    spelling = replace(SPELLINGS[random.choice(closed)], around=("{}",))
    # A text that begins with a square bracket would be a list.
    return spelling if name in LATEX or spelling.latex else replace(spelling, opening=("(",))


def grids(count: int, seed: str) -> Iterator[tuple[str, str, str]]:
    for number in range(count):
        random = Random(f"{seed}.{number}")
        rows, columns = random.randint(2, 4), random.randint(2, 4)
        trees = [[drawn(random, 1) for _ in range(columns)] for _ in range(rows)]
        for name, write in FORMATS.items():
            writer = Writer(suited(name, random), random)
            cells = [[writer.write(tree) for tree, _ in row] for row in trees]
            text = write(cells)
            yield name, _grid_outcome(text, trees), text


def _grid_outcome(text: str, trees: Sequence[Sequence[tuple[Tree, dict[str, Values]]]]) -> str:
    try:
        grid = read_grid(text)
    except GridError as error:
        return f"refused: {error.code}"
    if [len(row) for row in grid.rows] != [len(row) for row in trees]:
        return "refused: another size"
    found = [
        outcome(cell.text, *tree, degrees=False)
        for cells, row in zip(grid.rows, trees, strict=True)
        for cell, tree in zip(cells, row, strict=True)
    ]
    if "misread" in found:
        return "misread"
    return next((each for each in found if each != "read"), "read")


def submissions(count: int, seed: str) -> Iterator[tuple[str, str, str]]:
    for number in range(count):
        random = Random(f"{seed}.{number}")
        yield from graded.matrices(random, suited)
        yield from graded.tables(random, suited)


SECTIONS: Final[dict[str, Callable[[int, str], Iterable[tuple[str, str, str]]]]] = {
    "spellings": entries,
    "grids": grids,
    "submissions": submissions,
}


def tallied(section: str, count: int, seed: str) -> Tally:
    tally = Tally()
    for name, found, text in SECTIONS[section](count, seed):
        tally.add(name, found, text)
    return tally


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000, help="formulas; a tenth as many grids")
    parser.add_argument("--seed", default="1")
    options = parser.parse_args(arguments)
    failed = False
    for section in SECTIONS:
        count = options.count if section == "spellings" else max(1, options.count // 10)
        tally = tallied(section, count, options.seed)
        for name, counted in tally.outcomes.items():
            others = ", ".join(f"{times} {each}" for each, times in counted.most_common())
            share = tally.refused(name)
            failed |= share > REFUSED
            mark = "  <- too many" if share > REFUSED else ""
            sys.stdout.write(f"{section}, {name}: {share:.2%} not read ({others}){mark}\n")
        for text in tally.misread[:20]:
            sys.stdout.write(f"MISREAD {text!r}\n")
        failed |= bool(tally.misread)
    return int(failed)


if __name__ == "__main__":
    raise SystemExit(main())
