"""A slip that is made before an answer is written down: in the robot's table, joints or lengths.

Unlike the other misconceptions it is no formula for the wrong answer: it changes what the answer is
worked out from. So many slips are tried at once, by working the right answer out from the numbers
that each of them leaves.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from service.expressions.evaluation.samples import SymbolValues
from service.grading.misconception import Record
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
    """A cell whose constant part becomes ``factor`` times that of another cell, plus ``offset``.

    ``source`` is the other cell's row and column; without it, it is the cell itself. With
    ``moving`` the joint variables in the cells change along with their constants.
    """

    row: int
    column: int
    factor: float = 1.0
    offset: float = 0.0
    source: tuple[int, int] | None = None
    moving: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """What the right answer is worked out again with: other symbols, other cells.

    With ``misread`` the table is multiplied out with the link transform of the other convention.
    """

    symbols: tuple[SymbolChange, ...] = ()
    cells: tuple[CellChange, ...] = ()
    misread: bool = False


@dataclass(frozen=True, slots=True)
class Slip(Change):
    """A slip of some kind (``slip_kinds``), with what it changes.

    ``clause`` says what is wrong, as a clause that can stand in a list of several, and ``advice``
    what to look at; the ``correction`` is told apart. Symbols stand in braces in them, since the
    student may have other names, with the words for one that would give an entry away: "nothing
    moves with {d3:its variable}".
    """

    kind: Record
    clause: str
    advice: str
    correction: str = ""

    @property
    def code(self) -> str:
        """The code of its kind, or the name of a kind that is told beside others only."""
        return self.kind.name


def changed_values(changes: Sequence[Change], values: SymbolValues) -> dict[str, Numbers]:
    """The values ``(K · samples,)`` that K changes leave each symbol, those of one in a row."""
    names = list(values)
    if not names:
        return {}
    places = {name: i for i, name in enumerate(names)}
    right = np.array([values[name] for name in names])
    stacked = np.repeat(right[:, None], len(changes), axis=1)
    changed = [(k, symbol) for k, change in enumerate(changes) for symbol in change.symbols]
    if changed:
        targets = [places[each.symbol] for _, each in changed]
        sources = [places[each.source] for _, each in changed]
        factors = np.array([[each.factor] for _, each in changed])
        offsets = np.array([[each.offset] for _, each in changed])
        stacked[targets, [k for k, _ in changed]] = factors * right[sources] + offsets
    return dict(zip(names, stacked.reshape(len(names), -1), strict=True))


def change_cells(
    changes: Sequence[Change],
    tables: Table,
    right: Table,
    constants: Table,
    first_row: int = 0,
) -> None:
    """Change the cells of ``tables`` ``(rows, 4, K, count)``, some for each change, in place.

    ``right`` ``(rows, 4, count)`` is the right table, ``constants`` the same with all joint
    variables 0. All may begin with another than the table's ``first_row``.
    """
    cells = [(k, cell) for k, change in enumerate(changes) for cell in change.cells]
    if not cells:
        return
    written = np.stack([constants, right])
    numbers = np.array(
        [
            (k, cell.moving, cell.row, cell.column, *(cell.source or (cell.row, cell.column)))
            for k, cell in cells
        ]
    ).T
    ways, moving, rows, columns, source_rows, source_columns = numbers
    rows, source_rows = rows - first_row, source_rows - first_row
    factors = np.array([[cell.factor] for _, cell in cells])
    offsets = np.array([[cell.offset] for _, cell in cells])
    sources = written[moving, source_rows, source_columns]
    tables[rows, columns, ways] += factors * sources - written[moving, rows, columns] + offsets
