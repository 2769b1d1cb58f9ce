"""A reference robot given by a DH table: its formulas and their numbers."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from service.catalogue.robots.formulas import FormulaField
from service.expressions import Expression, Kind
from service.expressions.evaluation.samples import SymbolValues
from service.kinematics.chain import (
    COLUMNS,
    Row,
    Table,
    frames,
    joint_frames,
    modified_rows,
    pose,
    standard_rows,
)
from service.kinematics.dh import Convention
from service.kinematics.screws import moved
from service.kinematics.transforms import Matrices, Numbers

FormulaRow = Row[Expression]

# The quantities of the cells of a row, in the order of ``COLUMNS``.
ROW_QUANTITIES: tuple[Kind, Kind, Kind, Kind] = ("length", "angle", "length", "angle")
TOOL_ROW = "e"


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint: its index, variable and type. The index is also the label of its table row."""

    index: int
    variable: str
    prismatic: bool

    @property
    def column(self) -> str:
        """The table column of the joint variable: "theta" or "d"."""
        return "d" if self.prismatic else "theta"


@dataclass(frozen=True)
class ReferenceTable:
    """A DH table of formulas in one convention: a row for each joint, then any fixed rows."""

    convention: Convention
    joints: tuple[Joint, ...]
    rows: tuple[FormulaRow, ...]

    @property
    def lazy_rows(self) -> list[dict[str, str]]:
        """Return rows of zeros with only the joint variables in their columns."""
        rows = [dict.fromkeys(COLUMNS, "0") for _ in self.rows]
        for row, joint in zip(rows, self.joints, strict=False):
            row["d" if joint.prismatic else "theta"] = joint.variable
        return rows

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """The row labels: joint numbers, then "e" and "e2" for rows without a joint."""
        joints = tuple(str(joint.index) for joint in self.joints)
        fixed = (TOOL_ROW, f"{TOOL_ROW}2")
        return joints + fixed[: len(self.rows) - len(joints)]

    def values(self, values: SymbolValues, samples: int) -> Table:
        """Return the numbers of the table, ``(rows, 4, samples)``, at values of the symbols."""
        constants, formulas = self._constants_and_formulas
        table = np.repeat(constants[..., None], samples, axis=-1)
        for i, j, formula in formulas:
            table[i, j] = formula.evaluate(values)
        return table

    @cached_property
    def _constants_and_formulas(
        self,
    ) -> tuple[Numbers, tuple[tuple[int, int, Expression], ...]]:
        constants = np.zeros((len(self.rows), len(COLUMNS)))
        formulas = []
        for i, row in enumerate(self.rows):
            for j, formula in enumerate(row):
                if formula.symbols:
                    formulas.append((i, j, formula))
                else:
                    constants[i, j] = formula.evaluate({})
        return constants, tuple(formulas)


def at_home(joints: tuple[Joint, ...], values: SymbolValues, samples: int) -> SymbolValues:
    """Return the values with every joint variable set to 0."""
    return {**values, **{joint.variable: np.zeros(samples) for joint in joints}}


# The screw axis of a revolute and of a prismatic joint along the z axis.
ABOUT_Z = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
ALONG_Z = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class Robot:
    """A reference robot. ``tables`` has a table in each convention that can express it."""

    structure: str
    convention: Convention
    joints: tuple[Joint, ...]
    tables: Mapping[Convention, ReferenceTable]

    def pose(self, values: SymbolValues, samples: int) -> Matrices:
        """Return the pose of the end effector in the base frame, ``(samples, 4, 4)``."""
        table = self.tables[self.convention]
        return pose(table.values(values, samples), table.convention)

    def fields(self) -> Iterator[FormulaField]:
        """Yield every formula of the author's table with its field and quantity."""
        for i, row in enumerate(self.tables[self.convention].rows):
            for column, formula, quantity in zip(COLUMNS, row, ROW_QUANTITIES, strict=True):
                yield f"robot.table[{i}].{column}", formula, quantity

    @property
    def frames(self) -> tuple[int | str, ...]:
        """The names of the robot's frames from first to last: "base", numbers, "tool"."""
        first = self.joints[0].index
        last = first + len(self.tables[self.convention].rows) - 1
        return ("base", *range(first, last), "tool")

    def frame(self, name: int | str, values: SymbolValues, samples: int) -> Matrices:
        """Return the pose of a frame in the base frame, ``(samples, 4, 4)``."""
        return np.asarray(self.all_frames(values, samples)[self.frame_number(name)])

    def all_frames(self, values: SymbolValues, samples: int) -> Matrices:
        """Return the poses of all frames in the base frame, ``(frames, samples, 4, 4)``."""
        table = self.tables[self.convention]
        return frames(table.values(values, samples), table.convention)

    def frame_number(self, name: int | str) -> int:
        """The number of table rows between the base frame and the frame ``name``."""
        known = {"base": 0, "tool": len(self.tables[self.convention].rows)}
        return known[name] if isinstance(name, str) else name - self.joints[0].index + 1

    def has_frame(self, name: int | str) -> bool:
        """True if the robot has a frame of this name."""
        first = self.joints[0].index
        return isinstance(name, str) or first - 1 <= name < first + len(self.joints)

    def screws(self, values: SymbolValues, samples: int) -> Numbers:
        """Return the screw axes with all joint variables 0, ``(joints, samples, 6)``."""
        poses = self.all_frames(at_home(self.joints, values, samples), samples)
        on_axis = joint_frames(poses, self.convention)
        return np.stack(
            [
                moved(frame, ALONG_Z if joint.prismatic else ABOUT_Z)
                for joint, frame in zip(self.joints, on_axis, strict=False)
            ]
        )


def tables_in_both_conventions(
    joints: tuple[Joint, ...], rows: Sequence[FormulaRow], convention: Convention, zero: Expression
) -> dict[Convention, ReferenceTable]:
    """Return the author's table and, if possible, the equivalent one in the other convention."""
    if convention is Convention.STANDARD:
        other, regrouped = Convention.MODIFIED, modified_rows(rows, zero)
    else:
        other, regrouped = Convention.STANDARD, standard_rows(rows, zero)
    tables = {convention: ReferenceTable(convention, joints, tuple(rows))}
    begins_on_first_axis = all(_is_zero(cell) for cell in rows[0][:2])
    if other is Convention.MODIFIED or begins_on_first_axis:
        if len(regrouped) > len(joints) and all(_is_zero(cell) for cell in regrouped[-1]):
            regrouped.pop()
        tables[other] = ReferenceTable(other, joints, tuple(regrouped))
    return tables


def _is_zero(formula: Expression) -> bool:
    return not formula.symbols and float(formula.evaluate({})) == 0.0
