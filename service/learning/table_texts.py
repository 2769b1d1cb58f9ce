"""The correct table of a robot as texts that mean the same in every angle unit."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from service.catalogue import Joint, ReferenceTable, Robot
from service.expressions import Expression
from service.kinematics.chain import ALPHA, COLUMNS, THETA, D
from service.kinematics.dh import Convention

# The row and column of a cell.
TableCell: TypeAlias = tuple[int, int]
# The texts of the cells, row by row.
TableTexts: TypeAlias = tuple[tuple[str, ...], ...]

ANGLES: Final = (ALPHA, THETA)


@dataclass(frozen=True, slots=True)
class CellText:
    """A cell as the sum of a joint variable and a constant; the variable may be "".

    ``degrees`` is the constant if it is an angle without symbols, else None.
    """

    variable: str
    constant: str
    degrees: float | None

    @property
    def is_zero(self) -> bool:
        """True if the constant is 0."""
        return self.constant == "0"

    def text(self, *, variable: str | None = None, constant: str | None = None) -> str:
        """Return the text of the cell, with another ``variable`` or ``constant`` if given."""
        named = self.variable if variable is None else variable
        added = self.constant if constant is None else constant
        if not named:
            return added
        if added == "0":
            return named
        return f"{named} - {added[1:]}" if added.startswith("-") else f"{named} + {added}"


@dataclass(frozen=True, slots=True)
class ModelTable:
    """The correct table of a robot in one convention, with its joints.

    ``names`` are all symbols of the exercise.
    """

    convention: Convention
    joints: tuple[Joint, ...]
    labels: tuple[str, ...]
    cells: tuple[tuple[CellText, ...], ...]
    names: frozenset[str]

    @property
    def texts(self) -> TableTexts:
        """The texts of all cells."""
        return tuple(tuple(cell.text() for cell in row) for row in self.cells)

    def changed(self, changes: Mapping[TableCell, str]) -> TableTexts:
        """Return the texts of the table with new texts in some cells."""
        return tuple(
            tuple(changes.get((i, j), cell.text()) for j, cell in enumerate(row))
            for i, row in enumerate(self.cells)
        )

    def joint_of(self, row: int) -> Joint | None:
        """Return the joint of a row; None for a row without a joint."""
        return self.joints[row] if row < len(self.joints) else None


def model_table(robot: Robot, convention: Convention, names: frozenset[str]) -> ModelTable:
    """Return the correct table of a robot in a convention."""
    table = robot.tables[convention]
    return ModelTable(convention, table.joints, table.labels, _cells(table), names)


def _cells(table: ReferenceTable) -> tuple[tuple[CellText, ...], ...]:
    found = []
    for i, row in enumerate(table.rows):
        joint = table.joints[i] if i < len(table.joints) else None
        column = None if joint is None else D if joint.prismatic else THETA
        found.append(
            tuple(
                _cell(formula, joint.variable if joint and j == column else "", j in ANGLES)
                for j, formula in enumerate(row)
            )
        )
    return tuple(found)


def _cell(formula: Expression, variable: str, is_angle: bool) -> CellText:
    if formula.symbols - {variable}:
        constant = formula.text()
        if variable:
            # The variable comes first in a formula such as d3 + l1.
            constant = constant.removeprefix(variable).replace(" ", "").removeprefix("+") or "0"
        return CellText(variable, constant, None)
    value = float(np.asarray(formula.evaluate({variable: np.zeros(1)} if variable else {})).flat[0])
    if not is_angle:
        return CellText(variable, formula.text() if not variable else f"{value:.12g}", None)
    degrees = round(math.degrees(value), 9) + 0.0
    return CellText(variable, angle_text(degrees), degrees)


def angle_text(degrees: float) -> str:
    """Return an angle with its unit, such as 90deg; 0 has no unit."""
    return f"{degrees:.12g}deg" if degrees else "0"


def as_rows(texts: Sequence[Sequence[str]]) -> list[dict[str, str]]:
    """Return a table as the rows of an answer."""
    return [dict(zip(COLUMNS, row, strict=True)) for row in texts]
