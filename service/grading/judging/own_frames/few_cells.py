"""The valid table that a handed-in one is, or that it differs from in one cell or two.

Where base, tool and directions are given, a table is valid if and only if its pose is the
reference's wherever the joints are, and every cell moves as its own joint does and not otherwise.
So nothing has to be searched: what a cell would have to be follows from all the others.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from service.grading.comparison import difference
from service.grading.joint_motion import TOLERANCE, changes, moves_with
from service.grading.judging.own_frames.reference import reference_frames
from service.grading.judging.own_frames.row_roles import Role, joint_cells, motion_of
from service.grading.judging.own_frames.slip_likelihood import unlikelihood
from service.grading.part import Grading
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import HALF
from service.kinematics.cell_repairs import (
    SAME,
    Mend,
    mended,
    one_factor_mends,
    two_factor_mends,
)
from service.kinematics.chain import Table, frames, joint_frames
from service.kinematics.dh import Convention
from service.kinematics.factors import Cell, factors_of
from service.kinematics.frame_choice import WRONG_CELL, departure
from service.kinematics.transforms import Matrices, Numbers, inverse

# Enough samples to find out which cells mend a table; what they must be is told by all.
FEW = 3
FEW_SAMPLES = np.r_[:FEW, HALF : HALF + FEW]
MOST = 2


@dataclass(frozen=True, slots=True)
class FrameReading:
    """A table read in the student's own frames: ``expected`` is ``(rows, 4, SAMPLES)``.

    ``frames`` ``(joints, samples, 4, 4)`` are where the student's frames on the joint axes lie in
    the reference's. ``cost`` is that of ``frame_choice``: below 1 the table is valid.
    """

    roles: tuple[Role, ...]
    expected: Table
    frames: Matrices
    cost: float


@dataclass(frozen=True, slots=True)
class _Case:
    """A table to be mended: its values, and how each cell changes with the joints if it is right.

    ``table`` is ``(rows, 4, samples)``, ``motion`` ``(rows, 4, samples / 2)``; ``wrong`` are the
    cells that are wrong whatever the others are; ``variables`` what belongs in the cells of the
    joints' variables, in the order of the joints.
    """

    table: Table
    motion: Numbers
    wrong: frozenset[Cell]
    variables: Mapping[Cell, Numbers]
    convention: Convention
    grading: Grading

    @property
    def unit(self) -> float:
        """What lengths are measured in."""
        return self.grading.exercise.length_scale

    @property
    def reference(self) -> Matrices:
        """The reference's frames on the axes and its tool's, ``(joints + 1, SAMPLES, 4, 4)``."""
        return reference_frames(self.grading.exercise, self.convention, self.grading.samples)

    def apart(self, reached: Matrices) -> Matrices:
        """Of the frames ``(rows + 1, T, few, 4, 4)`` of T tables those on the joint axes.

        They are seen from the reference's, ``(joints, T, few, 4, 4)``.
        """
        on_axes = joint_frames(reached, self.convention)[[row for row, _ in self.variables]]
        return np.asarray(inverse(self.reference[:-1, FEW_SAMPLES])[:, None] @ on_axes)


def nearest_by_few_cells(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> FrameReading | None:
    """The table as it is, or the valid one that differs from it in one cell or else in two.

    Of several the one that asks for the likeliest slip. None where there is none; every role must
    have a row.
    """
    case = _case(roles, convention, grading)
    if len(case.wrong) > MOST:
        return None
    if not case.wrong:
        reached = frames(case.table, convention)
        if _coincide(reached[-1], case.reference[-1], case.unit):
            apart = case.apart(reached[:, None, FEW_SAMPLES])
            return FrameReading(roles, case.table, apart[:, 0], 0.0)
    mends = _mends(case)
    return _likeliest(mends, roles, case) if mends else None


def frames_from_reference(
    table: Table, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Matrices:
    """A table's frames on the joint axes as seen from the reference's, ``(joints, few, 4, 4)``."""
    case = _case(roles, convention, grading)
    return case.apart(frames(table, convention)[:, None, FEW_SAMPLES])[:, 0]


def _case(roles: tuple[Role, ...], convention: Convention, grading: Grading) -> _Case:
    table = np.array([role.row.values for role in roles if role.row])
    finite = np.isfinite(table).all(axis=-1)
    table[~finite] = 0.0
    motion = motion_of(roles, grading.samples)
    right = finite & moves_with(table, motion, IS_ANGLE[:, None])
    wrong = frozenset((i, column) for i, column in np.argwhere(~right).tolist())
    variables = {
        cell: grading.samples.values[joint.variable] for cell, joint in joint_cells(roles).items()
    }
    return _Case(table, motion, wrong, variables, convention, grading)


def _coincide(one: Matrices, other: Matrices, unit: float) -> bool:
    """Whether frames ``(samples, 4, 4)`` are the same."""
    off = np.abs(one - other).max(axis=0)
    return bool(off[:3, :3].max() < SAME and off[:3, 3].max() < SAME * unit)


def _mends(case: _Case) -> list[Mend]:
    """The ways to make the table valid by one cell; if there are none, by two."""
    factors = factors_of(case.table[..., FEW_SAMPLES], case.convention, case.unit)
    pose = _in_unit(case.reference[-1, FEW_SAMPLES], case.unit)
    by_factor = one_factor_mends(factors, pose)
    of_one = _fitting(by_factor, 1, case)
    return of_one or _fitting(chain(by_factor, two_factor_mends(factors, pose)), MOST, case)


def _likeliest(mends: Sequence[Mend], roles: tuple[Role, ...], case: _Case) -> FrameReading | None:
    """The table as one of the mends makes it: the one that asks for the likeliest slip.

    They are taken in the order of what their frames cost, until that alone is too much.
    """
    tables = np.repeat(case.table[:, :, None, FEW_SAMPLES], len(mends), axis=2)
    for k, mend in enumerate(mends):
        _fill(tables[:, :, k], mend)
    apart = case.apart(frames(tables, case.convention))
    departures = departure(apart.reshape(-1, *apart.shape[2:]), case.unit)
    departures = departures.reshape(apart.shape[:2]).sum(axis=0)
    best = None
    for k in np.argsort(departures, kind="stable").tolist():
        wrong = WRONG_CELL * len(mends[k].cells)
        cost = wrong + float(departures[k])
        if best is not None and cost >= best.cost:
            break
        table = _at_all_samples(mends[k].cells, case)
        if table is None:
            continue
        if len(mends) > 1:
            cost += sum(_unlikelihood(cell, table, case) for cell in mends[k].cells)
        if best is None or cost < best.cost:
            best = FrameReading(roles, table, apart[:, k], cost)
    return best


def _unlikelihood(cell: Cell, mended: Table, case: _Case) -> float:
    """How unlikely the slip is that a mended cell stands for."""
    angle = bool(IS_ANGLE[cell[1]])
    right = _at_rest(mended[cell], cell, case)
    written = None if cell in case.wrong else _at_rest(case.table[cell], cell, case)
    return unlikelihood(written, right, angle, case.grading)


def _at_rest(values: Numbers, cell: Cell, case: _Case) -> Numbers:
    """A cell that moves as it should without its joint's variable, in whichever sense it has it."""
    variable = case.variables.get(cell)
    if variable is None:
        return values
    angle = IS_ANGLE[cell[1]]
    agrees = np.abs(difference(changes(values), changes(variable), angle)).max() < TOLERANCE
    return values - variable if agrees else values + variable


def _fitting(mends: Iterable[Mend], count: int, case: _Case) -> list[Mend]:
    """The mends of so many cells after which each moves with the joints as it should.

    Their lengths are the table's own.
    """
    of_so_many = (_in_own_lengths(mend, case) for mend in mends if len(mend.cells) == count)
    return [
        mend
        for mend in of_so_many
        if case.wrong <= set(mend.cells) and _moves_so(mend, case, slice(FEW))
    ]


def _moves_so(mend: Mend, case: _Case, chosen: slice) -> bool:
    """Whether each value changes with the joints as its cell should."""
    return all(
        moves_with(value, case.motion[cell][chosen], IS_ANGLE[cell[1]])
        for cell, value in zip(mend.cells, mend.values, strict=True)
    )


def _at_all_samples(cells: Sequence[Cell], case: _Case) -> Table | None:
    """The table with these cells mended, ``(rows, 4, SAMPLES)``; None where they do not mend it."""
    factors = factors_of(case.table, case.convention, case.unit)
    values = mended(factors, _in_unit(case.reference[-1], case.unit), cells)
    if values is None:
        return None
    mend = _in_own_lengths(Mend(tuple(cells), values), case)
    if not _moves_so(mend, case, slice(None)):
        return None
    table = case.table.copy()
    _fill(table, mend)
    return table


def _fill(table: Table, mend: Mend) -> None:
    """Write the values of a mend into their cells of a table ``(rows, 4, samples)``."""
    for cell, value in zip(mend.cells, mend.values, strict=True):
        table[cell] = value


def _in_own_lengths(mend: Mend, case: _Case) -> Mend:
    """The same mend, its lengths no longer measured in the unit."""
    units = [[1.0 if IS_ANGLE[column] else case.unit] for _, column in mend.cells]
    return Mend(mend.cells, mend.values * np.array(units))


def _in_unit(pose: Matrices, unit: float) -> Matrices:
    measured = pose.copy()
    measured[..., :3, 3] /= unit
    return measured
