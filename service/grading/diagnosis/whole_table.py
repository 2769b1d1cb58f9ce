"""Slips that run through a whole table.

Each function is one misconception that the student may have held. It offers the table as it would
have been written without it; where that table describes the robot, the misconception explains the
answer.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.feedback import Finding
from service.grading.joint_motion import joint_counts
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import Samples
from service.grading.tolerances import INTENDED_POSE
from service.kinematics.chain import ALPHA, COLUMNS, THETA, A, D, Table
from service.kinematics.dh import Convention

SYMBOLS = ("a", "α", "d", "θ")


@dataclass(frozen=True, slots=True)
class WrittenTable:
    """A table that is wrong: numbers ``(rows, 4, samples)``, angles in radians, all cells read.

    Its values are the sum of ``constants`` and ``motion``, which is what the joint variables
    contribute. ``reference`` is the reference's table where it has as many rows, to tell what fell
    off the end.
    """

    constants: Table
    motion: Table
    convention: Convention
    reference: Table | None = None

    @property
    def values(self) -> Table:
        """The table as it was handed in."""
        return self.constants + self.motion

    def subset(self, count: int) -> "WrittenTable":
        """The same table at a subset of its samples."""
        constants, motion = (
            Samples.subset_of(cells, count) for cells in (self.constants, self.motion)
        )
        reference = None if self.reference is None else Samples.subset_of(self.reference, count)
        return WrittenTable(constants, motion, self.convention, reference)

    def changed(self, constants: Table, motion: Table | None = None) -> "WrittenTable":
        """The same table with other constants, or with other joint variables too."""
        moves = self.motion if motion is None else motion
        return WrittenTable(constants, moves, self.convention, self.reference)


class Repair(NamedTuple):
    """The table without one misconception, and how to tell of the misconception."""

    table: WrittenTable
    finding: Callable[[], Finding]


Misconception = Callable[[WrittenTable], Iterator[Repair]]
Validity = Callable[[NDArray[np.float64], Convention], NDArray[np.bool_]]


def written_table(
    values: Table,
    convention: Convention,
    reference: Table | None,
    joints: tuple[Joint, ...],
    samples: Samples,
) -> WrittenTable:
    """The table with the joint variables in each cell found out."""
    cells = values.reshape(-1, values.shape[-1])
    counts, _ = joint_counts(cells, joints, samples, np.tile(IS_ANGLE, len(values)))
    motion = counts @ np.array([samples.values[joint.variable] for joint in joints])
    motion = motion.reshape(values.shape)
    same_size = reference is not None and len(reference) == len(values)
    return WrittenTable(values - motion, motion, convention, reference if same_size else None)


def other_convention(table: WrittenTable) -> Iterator[Repair]:
    """The table was set up by the rules of the other convention."""
    used, meant = Convention.MODIFIED, Convention.STANDARD
    if table.convention is Convention.MODIFIED:
        used, meant = meant, used
    names = {Convention.STANDARD: "standard (distal)", Convention.MODIFIED: "modified (proximal)"}
    yield Repair(
        replace(table, convention=used),
        lambda: Finding(
            "other_convention",
            f"This is a right table in the {names[used]} convention, but it was read in the "
            f"{names[meant]} one: look which link's a and α belong in row i.",
            f"In the {names[meant]} convention a and α move by one row.",
        ),
    )


def link_columns_shifted(table: WrittenTable) -> Iterator[Repair]:
    """The link's own columns, a and α or one of them, stand one row too early or too late."""
    for columns in (slice(A, ALPHA + 1), slice(A, A + 1), slice(ALPHA, ALPHA + 1)):
        for late in (True, False):
            finding = partial(_shifted, " and ".join(SYMBOLS[columns]), late=late)
            constants = table.constants.copy()
            end = -1 if late else 0
            if late:
                constants[:-1, columns] = table.constants[1:, columns]
            else:
                constants[1:, columns] = table.constants[:-1, columns]
            constants[end, columns] = table.constants[0 if late else -1, columns]
            yield Repair(table.changed(constants), finding)
            if table.reference is not None:
                completed = constants.copy()
                completed[end, columns] = table.reference[end, columns]
                yield Repair(table.changed(completed), finding)


def _shifted(named: str, *, late: bool) -> Finding:
    return Finding(
        "link_columns_shifted",
        f"{named} stand one row too {'late' if late else 'early'}: check which link each of them "
        f"describes.",
        f"Move {named} {'up' if late else 'down'} by one row.",
    )


def columns_swapped(table: WrittenTable) -> Iterator[Repair]:
    """What is measured on x was taken for what is measured on z: a for d, or α for θ.

    In the whole table or in one row; the joint variables may have gone along or not.
    """
    for one, other in ((A, D), (ALPHA, THETA)):
        still = np.abs(table.constants[:, one] - table.constants[:, other]).max(axis=-1) > 0
        moving = np.abs(table.motion[:, one] - table.motion[:, other]).max(axis=-1) > 0
        for row in (None, *range(len(still))):
            rows = slice(None) if row is None else slice(row, row + 1)
            finding = partial(_swapped, SYMBOLS[one], SYMBOLS[other], row)
            constants = _exchanged(table.constants, rows, one, other)
            if still[rows].any():
                yield Repair(table.changed(constants), finding)
            if moving[rows].any():
                motion = _exchanged(table.motion, rows, one, other)
                yield Repair(table.changed(constants, motion), finding)


def _exchanged(cells: Table, rows: slice, one: int, other: int) -> Table:
    exchanged = cells.copy()
    exchanged[rows, one], exchanged[rows, other] = cells[rows, other], cells[rows, one]
    return exchanged


def _swapped(one: str, other: str, row: int | None) -> Finding:
    where = "" if row is None else f" in row {row + 1}"
    return Finding(
        "columns_swapped",
        f"{one} and {other} are exchanged{where}: one is measured along or about x, the other "
        f"along or about z.",
        f"Exchange {one} and {other}{where}.",
    )


def row_order(table: WrittenTable) -> Iterator[Repair]:
    """Two rows, or all of them, stand in the wrong order."""
    rows = range(len(table.constants))
    orders = [_with_exchanged(rows, i, j) for i, j in combinations(rows, 2)]
    if len(rows) > 2:
        orders.append(list(reversed(rows)))
    for order in orders:
        yield Repair(
            table.changed(table.constants[order], table.motion[order]), partial(_reordered, order)
        )


def _with_exchanged(rows: range, i: int, j: int) -> list[int]:
    order = list(rows)
    order[i], order[j] = j, i
    return order


def _reordered(order: list[int]) -> Finding:
    moved = [str(i + 1) for i, row in enumerate(order) if row != i]
    return Finding(
        "row_order",
        f"Rows {' and '.join(moved) if len(moved) == 2 else ', '.join(moved)} stand in the wrong "
        f"order: row i belongs to joint i, counted from the base.",
    )


def degrees_as_radians(table: WrittenTable) -> Iterator[Repair]:
    """All angles were meant in degrees, where radians are read."""
    if np.abs(table.constants[:, IS_ANGLE]).max() > 2 * np.pi:
        yield _angles_rescaled(
            table,
            np.pi / 180,
            Finding(
                "degrees_as_radians",
                "The angles were read in radians, but they fit in degrees: write the unit (90deg "
                "or 90°), use pi, or hand the table in with the angle unit degrees.",
            ),
        )


def radians_as_degrees(table: WrittenTable) -> Iterator[Repair]:
    """All angles were meant in radians, where degrees are read."""
    if np.abs(table.constants[:, IS_ANGLE]).max() <= np.radians(2 * np.pi):
        yield _angles_rescaled(
            table,
            180 / np.pi,
            Finding(
                "radians_as_degrees",
                "The angles were read in degrees, but they fit in radians: use pi, or hand the "
                "table in with the angle unit radians.",
            ),
        )


def _angles_rescaled(table: WrittenTable, factor: float, finding: Finding) -> Repair:
    constants = table.constants.copy()
    constants[:, IS_ANGLE] *= factor
    return Repair(table.changed(constants), lambda: finding)


def column_sign(table: WrittenTable) -> Iterator[Repair]:
    """One kind of parameter was measured in the wrong sense throughout."""
    for column in range(len(COLUMNS)):
        if table.constants[:, column].any():
            constants = table.constants.copy()
            constants[:, column] *= -1
            yield Repair(table.changed(constants), partial(_turned_sign, column))


def _turned_sign(column: int) -> Finding:
    sense = ("along x", "about x", "along z", "about z")[column]
    return Finding(
        "column_sign",
        f"{SYMBOLS[column]} has the wrong sign throughout: it is measured {sense}, positive by the "
        f"right-hand rule.",
        f"Turn the sign of every {SYMBOLS[column]}.",
    )


# A student may do two of these at once, or one of them and another slip.
BASIC: tuple[Misconception, ...] = (other_convention, degrees_as_radians, radians_as_degrees)
MISCONCEPTIONS: tuple[Misconception, ...] = (
    *BASIC,
    link_columns_shifted,
    column_sign,
    columns_swapped,
    row_order,
)


# Misconceptions one after the other, and of each which of its repairs, by number.
Chain = tuple[tuple[Misconception, int], ...]


@dataclass(frozen=True, slots=True)
class Explanation:
    """Misconceptions that explain the whole of a table, and how to repair it at any samples."""

    chain: Chain
    findings: tuple[Finding, ...]

    def repaired(self, table: WrittenTable) -> WrittenTable:
        """The table, at whatever samples, as it would have been without the misconceptions."""
        for misconception, which in self.chain:
            table = list(misconception(table))[which].table
        return table


def explanations(table: WrittenTable, valid: Validity, *, combine: bool) -> list[Explanation]:
    """What explains the whole table: one misconception, or two where ``combine`` allows.

    ``valid`` tells which tables describe the robot. A misconception that would change nothing is no
    explanation.
    """
    found = _explaining(table, _repairs(table, MISCONCEPTIONS), valid)
    if not found and combine:
        pairs = [
            (chain + rest, (*repairs, *later))
            for i, basic in enumerate(BASIC)
            for chain, repairs in _repairs(table, (basic,))
            for rest, later in _repairs(repairs[-1].table, MISCONCEPTIONS[i + 1 :])
        ]
        found = _explaining(table, pairs, valid)[:1]
    return [
        Explanation(chain, tuple(repair.finding() for repair in repairs))
        for chain, repairs in found
    ]


_Repaired = tuple[Chain, tuple[Repair, ...]]


def _repairs(table: WrittenTable, misconceptions: Sequence[Misconception]) -> list[_Repaired]:
    return [
        (((misconception, which),), (repair,))
        for misconception in misconceptions
        for which, repair in enumerate(misconception(table))
    ]


def _explaining(
    table: WrittenTable, repaired: Sequence[_Repaired], valid: Validity
) -> list[_Repaired]:
    """The chains of repairs that change the table and end in a valid one, in their order."""
    explains = np.zeros(len(repaired), dtype=np.bool_)
    for convention in Convention:
        ending = [
            i
            for i, (_, repairs) in enumerate(repaired)
            if repairs[-1].table.convention is convention
        ]
        if ending:
            tables = np.array([repaired[i][1][-1].table.values for i in ending])
            explains[ending] = valid(tables, convention)
            if convention is table.convention:
                changed = np.abs(tables - table.values).max(axis=(1, 2, 3)) > INTENDED_POSE
                explains[ending] &= changed
    return [found for found, yes in zip(repaired, explains, strict=True) if yes]
