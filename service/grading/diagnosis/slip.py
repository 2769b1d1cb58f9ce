"""A slip that is made before an answer is written down: in the robot's table, joints or lengths.

Unlike the other misconceptions it is no formula for the wrong answer: it changes what the answer is
worked out from. So many slips are tried at once, by working the right answer out from the numbers
that each of them leaves.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from service.expressions.evaluation.samples import SymbolValues
from service.kinematics.chain import Table
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class SymbolChange:
    """A symbol that is taken to be ``factor · source + offset``; ``source`` is a symbol too."""

    symbol: str
    source: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class CellChange:
    """A cell of which the constant part counts ``factor`` times, and to which a number is added."""

    row: int
    column: int
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Slip:
    """A slip by its code, with what it changes.

    ``clause`` says what is wrong, as a clause that can stand in a list of several, and ``advice``
    what to look at; the ``correction`` is told apart. Symbols stand in braces in them, since the
    student may have other names, with the words for one that would give an entry away: "nothing
    moves with {d3:its variable}".
    """

    code: str
    clause: str
    advice: str
    correction: str = ""
    symbols: tuple[SymbolChange, ...] = ()
    cell: CellChange | None = None


def changed_values(slips: Sequence[Slip], values: SymbolValues) -> dict[str, Numbers]:
    """The values ``(K · samples,)`` that K slips leave each symbol, one slip after the other."""
    names = list(values)
    places = {name: i for i, name in enumerate(names)}
    right = np.array([values[name] for name in names])
    stacked = np.repeat(right[:, None], len(slips), axis=1)
    changes = [(k, change) for k, slip in enumerate(slips) for change in slip.symbols]
    if changes:
        targets = [places[change.symbol] for _, change in changes]
        sources = [places[change.source] for _, change in changes]
        factors = np.array([[change.factor] for _, change in changes])
        offsets = np.array([[change.offset] for _, change in changes])
        stacked[targets, [k for k, _ in changes]] = factors * right[sources] + offsets
    return dict(zip(names, stacked.reshape(len(names), -1), strict=True))


def change_cells(
    slips: Sequence[Slip], tables: Table, constants: Table, first_row: int = 0
) -> None:
    """Change the cells of ``tables`` ``(rows, 4, K, count)``, one for each slip, in place.

    ``constants`` ``(rows, 4, count)`` is the right table with all joint variables 0. Both may begin
    with another than the table's ``first_row``.
    """
    changes = [(k, slip.cell) for k, slip in enumerate(slips) if slip.cell is not None]
    if changes:
        rows, columns = (
            [cell.row - first_row for _, cell in changes],
            [cell.column for _, cell in changes],
        )
        factors = np.array([[cell.factor - 1.0] for _, cell in changes])
        offsets = np.array([[cell.offset] for _, cell in changes])
        added = factors * constants[rows, columns] + offsets
        tables[rows, columns, [k for k, _ in changes]] += added
