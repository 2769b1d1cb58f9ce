"""A slip: a mistake in the robot's table, joints or lengths, which leads to a wrong answer."""

# Many slips are tried at once: a single computation takes the changed inputs of all slips.

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from service.expressions.evaluation.samples import SymbolValues
from service.grading.misconception import Record
from service.kinematics.chain import Table
from service.kinematics.transforms import Numbers
from service.translations import Sentence


@dataclass(frozen=True, slots=True)
class SymbolChange:
    """A changed symbol: its value becomes ``factor`` times the ``source``, plus ``offset``."""

    symbol: str
    source: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class CellChange:
    """A changed constant of a cell: ``factor`` times the ``source``, plus ``offset``."""

    row: int
    column: int
    factor: float = 1.0
    offset: float = 0.0
    # The row and column of the cell whose constant is multiplied; None for the changed cell itself.
    source: tuple[int, int] | None = None
    # If True, the joint variables in the cells change along with the constants.
    moving: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """A change to the symbols or the table cells from which an answer is computed."""

    symbols: tuple[SymbolChange, ...] = ()
    cells: tuple[CellChange, ...] = ()
    # If True, the links are computed with the formula of the other convention.
    misread: bool = False


@dataclass(frozen=True, slots=True)
class Names:
    """The names of symbols in a message."""

    # Returns the name that the student uses for a symbol.
    name: Callable[[str], str]
    # True for a symbol whose name would reveal the correct entry.
    gives_away: Callable[[str], bool]

    def shown(self, symbol: str) -> str | None:
        """Return the name of a symbol, or None if the name would reveal the correct entry."""
        return None if self.gives_away(symbol) else self.name(symbol)


@dataclass(frozen=True, slots=True)
class SlipWords:
    """The sentences about a slip."""

    # What is wrong, in a clause, so that several slips can be listed.
    clause: Sentence
    # What is wrong and what to check, for this slip alone.
    hint: str
    correction: str = ""


@dataclass(frozen=True, slots=True)
class Slip(Change):
    """A possible mistake of a student: its kind, and the change that it makes."""

    kind: Record
    # Returns the sentences about the slip, with the names that the student uses.
    words: Callable[[Names], SlipWords]

    @property
    def code(self) -> str:
        """The code of the kind of slip, or the name of a kind without a code."""
        return self.kind.name


def changed_values(changes: Sequence[Change], values: SymbolValues) -> dict[str, Numbers]:
    """Return the values ``(K · samples,)`` of each symbol after each of K changes.

    The values after one change are consecutive.
    """
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
    """Apply each of K changes to its own table in ``tables``, in place.

    ``tables`` is ``(rows, 4, K, count)`` for ``count`` samples.
    """
    # right (rows, 4, count) is the correct table, constants the same table with all joint variables
    # 0. All three arrays begin with row first_row of the whole table.
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
