"""Generate slips in a single cell of a table."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tests.frame_choice.cells import Cell
from tests.frame_choice.generator import Table
from tests.frame_choice.robots import ALPHA, COLUMNS, THETA, Robot

QUARTER = np.pi / 2


@dataclass(frozen=True)
class Edit:
    """A slip: its kind, its row and column, and the wrong cell."""

    kind: str
    row: int
    column: int
    cell: Cell

    def __str__(self) -> str:
        return f"{self.kind} in row {self.row + 1} {COLUMNS[self.column]}: {self.cell.text}"


def random_edit(table: Table, rng: np.random.Generator, not_in_row: int | None = None) -> Edit:
    """Return a random slip in a random cell."""
    rows = [i for i in range(len(table.rows)) if i != not_in_row]
    row, column = int(rng.choice(rows)), int(rng.integers(4))
    cell = table.rows[row][column]
    slips = list(_slips(table.robot, row, column, cell, rng))
    kinds = sorted({kind for kind, _ in slips})
    kind = str(rng.choice(kinds))
    chosen = [slip for name, slip in slips if name == kind]
    return Edit(kind, row, column, chosen[int(rng.integers(len(chosen)))])


def _slips(
    robot: Robot, row: int, column: int, cell: Cell, rng: np.random.Generator
) -> Iterator[tuple[str, Cell]]:
    angle = column in (ALPHA, THETA)
    amount = float(round(rng.uniform(0.1, 1.2 if angle else 0.5), 2) * rng.choice([-1, 1]))
    yield "shift", replace(cell, constant=cell.constant + amount)
    if angle:
        for turn in (QUARTER, -QUARTER):
            yield "quarter turn", replace(cell, constant=cell.constant + turn)
    else:
        yield from _letters(robot, cell)
    if cell.variables:
        yield from _variables(robot, row, cell)
    if not cell.is_zero:
        yield "sign", _negated(cell, variables=True, constant=True)
    if cell.constant or cell.letters or cell.terms:
        yield "zeroed", Cell(cell.angle, variables=cell.variables)
        if cell.variables:
            yield "sign of the constant", _negated(cell, variables=False, constant=True)


def _letters(robot: Robot, cell: Cell) -> Iterator[tuple[str, Cell]]:
    for name in robot.lengths:
        if not cell.letters:
            yield "another letter too", replace(cell, letters={name: 1.0})
        elif name not in cell.letters:
            for swapped in cell.letters:
                letters = {name if n == swapped else n: m for n, m in cell.letters.items()}
                yield "another letter", replace(cell, letters=letters)


def _variables(robot: Robot, row: int, cell: Cell) -> Iterator[tuple[str, Cell]]:
    [sign] = cell.variables.values()
    yield "variable missing", replace(cell, variables={})
    yield "sign of the variable", _negated(cell, variables=True, constant=False)
    for i, name in enumerate(robot.joints):
        if i != row and robot.structure[i] == robot.structure[row]:
            yield "another variable", replace(cell, variables={name: sign})


def _negated(cell: Cell, *, variables: bool, constant: bool) -> Cell:
    return Cell(
        angle=cell.angle,
        constant=-cell.constant if constant else cell.constant,
        letters={n: -m if constant else m for n, m in cell.letters.items()},
        terms={n: -m if constant else m for n, m in cell.terms.items()},
        variables={n: -m if variables else m for n, m in cell.variables.items()},
    )
