"""Find the valid table that differs from a submitted one in at most two cells or one row.

A table is valid if it describes the robot. Base, tool and directions are given here, so the right
value of a cell follows from all other cells.
"""

# A table is valid if its tool pose equals that of the reference at all joint values, and every cell
# changes only as its own joint variable does.

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from service.grading.judging.own_frames.nearest.slip_likelihood import slip_penalty
from service.grading.judging.own_frames.nearest.units_lost import units_lost
from service.grading.judging.own_frames.reference import reference_frames
from service.grading.judging.own_frames.row_roles import Role, handed_in_values, variables_of
from service.grading.numerics.comparison import difference
from service.grading.numerics.joint_motion import changes, moves_with
from service.grading.numerics.samples import HALF
from service.grading.numerics.tolerances import SAME_MOTION
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import Table, frames, joint_frames
from service.kinematics.dh import Convention
from service.kinematics.factors import CellIndex, Factors, factors_of
from service.kinematics.frames.frame_choice import WRONG_CELL, departure
from service.kinematics.repairs.cell_repairs import (
    CellRepair,
    one_factor_repairs,
    repaired_values,
    two_factor_repairs,
)
from service.kinematics.repairs.row_repairs import one_row_repairs, repaired_row
from service.kinematics.tolerances import SAME_POSE
from service.kinematics.transforms import Matrices, Numbers, inverse

# The number of samples at which repairs are searched; their values are then computed at all
# samples.
SUBSET = 3
SUBSET_SAMPLES = np.r_[:SUBSET, HALF : HALF + SUBSET]
MAX_CELLS = 2
# The discount of two wrong cells in one row against two in several rows, if the frames are the
# reference's.
IN_ONE_ROW = 0.3
# The cost of a repair that changes unread cells only: the table may be right.
UNREAD = WRONG_CELL / 10


@dataclass(frozen=True, slots=True)
class NearestTable:
    """The table that describes the robot and is nearest to the submitted table.

    The submitted table is valid if ``cost`` is below 1.
    """

    # ``frames`` are the valid table's frames on the joint axes, as seen from the reference's
    # frames.
    # ``frames`` is ``(joints, samples, 4, 4)``; ``frame_choice`` explains ``cost``. ``lost`` is the
    # loss for the wrong cells: a single wrong cell loses one unit. It is computed for the valid
    # table with the smallest loss (not always this table), and infinite if unknown.
    roles: tuple[Role, ...]
    expected: Table
    frames: Matrices
    cost: float
    lost: float = np.inf


@dataclass(frozen=True, slots=True)
class _Case:
    """A table to be repaired."""

    # ``table`` is ``(rows, 4, samples)``. ``variables`` has the joint variable that belongs in each
    # cell, or 0. ``wrong`` has the indices of the cells that change with the joints in another way.
    roles: tuple[Role, ...]
    table: Table
    variables: Table
    wrong: frozenset[CellIndex]
    convention: Convention
    grading: Grading

    @property
    def unit(self) -> float:
        # The unit of length for comparing poses.
        return self.grading.exercise.length_scale

    @property
    def reference(self) -> Matrices:
        return reference_frames(self.grading.exercise, self.convention, self.grading.samples)

    def from_reference(self, reached: Matrices) -> Matrices:
        # ``reached`` ``(rows + 1, T, subset, 4, 4)`` has all frames of T tables; the result is
        # ``(joints, T, subset, 4, 4)``.
        return _from_reference(reached, self.roles, self.convention, self.grading)


def nearest_by_few_cells(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> NearestTable | None:
    """Return the valid table that differs from the submitted one in at most two cells or one row.

    Of several such tables, the one with the likeliest mistake is taken. No row may be missing.
    """
    case = _case(roles, convention, grading)
    if len(case.wrong) > MAX_CELLS and len({row for row, _ in case.wrong}) > 1:
        return None
    if not case.wrong:
        reached = frames(case.table, convention)
        if np.abs(_in_unit(reached[-1] - case.reference[-1], case.unit)).max() < SAME_POSE:
            on_axes = case.from_reference(reached[:, None, SUBSET_SAMPLES])
            return NearestTable(roles, case.table, on_axes[:, 0], 0.0)
    repairs = _repairs(case)
    nearest = _likeliest(repairs, case) if repairs else None
    if nearest is None:
        return None
    return replace(nearest, lost=min(_lost(repair, case) for repair in repairs))


def single_repairs(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> frozenset[CellIndex]:
    """Return the cells of which each, if corrected alone, makes the table describe the robot.

    Every row and every cell must have a value.
    """
    case = _case(roles, convention, grading)
    factors = factors_of(case.table[..., SUBSET_SAMPLES], case.convention, case.unit)
    pose = _in_unit(case.reference[-1, SUBSET_SAMPLES], case.unit)
    repairs = _admissible(one_factor_repairs(factors, pose), [1], case)
    return frozenset(cell for repair in repairs for cell in repair.cells)


def frames_from_reference(
    table: Table, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Matrices:
    """Return a table's frames on the joint axes, relative to the reference frames.

    The shape is ``(joints, samples, 4, 4)``.
    """
    # At a subset of the samples.
    reached = frames(table[..., SUBSET_SAMPLES], convention)[:, None]
    return _from_reference(reached, roles, convention, grading)[:, 0]


def _from_reference(
    reached: Matrices, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Matrices:
    # ``reached`` ``(rows + 1, T, subset, 4, 4)`` has all frames of T tables; the result is
    # ``(joints, T, subset, 4, 4)``.
    of_joints = [role.joint is not None for role in roles]
    on_axes = joint_frames(reached, convention)[of_joints]
    reference = reference_frames(grading.exercise, convention, grading.samples)
    return np.asarray(inverse(reference[:-1, SUBSET_SAMPLES])[:, None] @ on_axes)


def _case(roles: tuple[Role, ...], convention: Convention, grading: Grading) -> _Case:
    table = handed_in_values(roles)
    finite = np.isfinite(table).all(axis=-1)
    table[~finite] = 0.0
    variables = variables_of(roles, grading.samples)
    right = finite & moves_with(table, changes(variables), IS_ANGLE[:, None])
    places = [] if right.all() else np.argwhere(~right).tolist()
    wrong = frozenset((i, column) for i, column in places)
    return _Case(roles, table, variables, wrong, convention, grading)


def _repairs(case: _Case) -> list[CellRepair]:
    factors = factors_of(case.table[..., SUBSET_SAMPLES], case.convention, case.unit)
    pose = _in_unit(case.reference[-1, SUBSET_SAMPLES], case.unit)
    by_factor = one_factor_repairs(factors, pose)
    if by_one_cell := _admissible(by_factor, [1], case):
        return by_one_cell
    by_two_cells = chain(by_factor, two_factor_repairs(factors, pose))
    by_row = one_row_repairs(factors, pose, case.wrong)
    return [*_admissible(by_two_cells, [2], case), *_admissible(by_row, [3, 4], case)]


def _admissible(
    repairs: Iterable[CellRepair], counts: Container[int], case: _Case
) -> list[CellRepair]:
    # The number of cells of a repair must be in ``counts``; lengths are returned in the table's
    # unit.
    of_count = (_in_table_unit(repair, case) for repair in repairs if len(repair.cells) in counts)
    return [
        repair
        for repair in of_count
        if case.wrong <= set(repair.cells) and _moves_rightly(repair, case, slice(SUBSET))
    ]


def _in_one_row(repair: CellRepair) -> bool:
    return len({row for row, _ in repair.cells}) == 1


def _likeliest(repairs: Sequence[CellRepair], case: _Case) -> NearestTable | None:
    # A repair is likely if it has few cells, if these are in one row, if it leads to frames near
    # the reference's frames, and if students often make the mistake that it repairs.
    tables = np.repeat(case.table[:, :, None, SUBSET_SAMPLES], len(repairs), axis=2)
    for k, repair in enumerate(repairs):
        _fill(tables[:, :, k], repair)
    on_axes = case.from_reference(frames(tables, case.convention))
    departures = departure(on_axes.reshape(-1, *on_axes.shape[2:]), case.unit)
    costs = departures.reshape(on_axes.shape[:2]).sum(axis=0)
    costs += [_base_cost(*each, case) for each in zip(repairs, costs.tolist(), strict=True)]
    factors = factors_of(case.table, case.convention, case.unit)
    best = None
    for k in np.argsort(costs, kind="stable").tolist():
        cells, cost = repairs[k].cells, float(costs[k])
        if best is not None and cost >= best.cost:
            break
        table = _repaired(cells, factors, case)
        if table is None:
            continue
        if len(repairs) > 1:
            cost += sum(_penalty(cell, table, case) for cell in cells)
        if best is None or cost < best.cost:
            best = NearestTable(case.roles, table, on_axes[:, k], cost)
    return best


def _lost(repair: CellRepair, case: _Case) -> float:
    if len(repair.cells) == 1:
        return WRONG_CELL
    repaired = case.table[..., SUBSET_SAMPLES].copy()
    _fill(repaired, repair)
    wrong = np.zeros(repaired.shape[:2], np.bool_)
    wrong[tuple(np.array(repair.cells).T)] = True
    return units_lost(repaired, case.variables[..., SUBSET_SAMPLES], wrong, case.unit)


def _base_cost(repair: CellRepair, departures: float, case: _Case) -> float:
    # ``departures`` is the cost of the frames.
    rows = [role.row for role in case.roles]
    if all((row := rows[i]) and not row.entries[c].readable for i, c in repair.cells):
        return UNREAD
    if len(repair.cells) == 1:
        return WRONG_CELL
    is_preferred = not departures and _in_one_row(repair)
    return WRONG_CELL * len(repair.cells) - IN_ONE_ROW * is_preferred


def _penalty(cell: CellIndex, repaired: Table, case: _Case) -> float:
    right = _constant(repaired[cell], cell, case)
    written = None if cell in case.wrong else _constant(case.table[cell], cell, case)
    return slip_penalty(written, right, bool(IS_ANGLE[cell[1]]), case.grading)


def _constant(values: Numbers, cell: CellIndex, case: _Case) -> Numbers:
    # The values must be a constant, plus or minus the joint variable that belongs in the cell.
    variable: Numbers = case.variables[cell]
    error = np.abs(difference(changes(values), changes(variable), IS_ANGLE[cell[1]]))
    return values - variable if error.max() < SAME_MOTION else values + variable


def _repaired(cells: Sequence[CellIndex], factors: Factors, case: _Case) -> Table | None:
    pose = _in_unit(case.reference[-1], case.unit)
    if len(cells) <= MAX_CELLS:
        values = repaired_values(factors, pose, cells)
    else:
        values = repaired_row(factors, pose, cells[0][0])
        values = None if values is None else values[[column for _, column in cells]]
    if values is None:
        return None
    repair = _in_table_unit(CellRepair(tuple(cells), values), case)
    if not _moves_rightly(repair, case, slice(None)):
        return None
    table = case.table.copy()
    _fill(table, repair)
    return table


def _moves_rightly(repair: CellRepair, case: _Case, samples: slice) -> bool:
    return all(
        moves_with(value, changes(case.variables[cell])[samples], IS_ANGLE[cell[1]])
        for cell, value in zip(repair.cells, repair.values, strict=True)
    )


def _fill(table: Table, repair: CellRepair) -> None:
    for cell, value in zip(repair.cells, repair.values, strict=True):
        table[cell] = value


def _in_table_unit(repair: CellRepair, case: _Case) -> CellRepair:
    units = [[1.0 if IS_ANGLE[column] else case.unit] for _, column in repair.cells]
    return CellRepair(repair.cells, repair.values * np.array(units))


def _in_unit(pose: Matrices, unit: float) -> Matrices:
    measured = pose.copy()
    measured[..., :3, 3] /= unit
    return measured
