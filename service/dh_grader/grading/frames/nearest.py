"""Find the valid table nearest to a submitted one: one wrong cell, few cells, or one row.

A table is valid if it describes the robot. Of several mistakes that explain a wrong table, the
likeliest is taken. The search for the cheapest frames, row by row, is ``kinematics.frame_choice``;
what the mistakes are called is not known here.
"""

from collections.abc import Container, Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate, chain, compress, product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from dh_grader.grading.frames import (
    FrameFreedom,
    Mechanism,
    Rereadable,
    Role,
    WrittenTable,
    as_table,
    directed,
    frames_on_axes,
    handed_in_values,
    joint_cells,
    mechanism_at,
    possible_bases,
    reference_frames,
    regrouped,
    row_constants,
    targets_of,
    valid_tables,
    variables_of,
    written_table,
)
from dh_grader.grading.judging import Grading
from dh_grader.grading.marks import BESIDES
from dh_grader.grading.misconception import hypotheses_of, multiples
from dh_grader.grading.numbers import (
    HALF,
    INTENDED_POSE,
    SAME_CONTENT,
    SAME_MOTION,
    SAME_TERM,
    UNCHANGED_CELL,
    changes,
    difference,
    moves_with,
    nearly_equal,
)
from dh_grader.grading.reading.table import GIVEN_UP, IS_ANGLE, computed_row
from dh_grader.kinematics import (
    PARALLEL,
    SAME_POSE,
    A,
    CellIndex,
    Convention,
    D,
    Factors,
    Integers,
    Matrices,
    Numbers,
    Table,
    X,
    cross,
    factors_of,
    frames,
    identity,
    inverse,
    joint_frames,
    pose,
)
from dh_grader.kinematics.frame_choice import (
    WRONG_CELL,
    ChainMatch,
    RowConstants,
    Target,
    align_first_axes,
    departure,
    match_as_written,
    match_tables,
    nearest_table,
    reversed_cells,
    reversed_rows,
    reversed_targets,
)
from dh_grader.kinematics.frame_choice_repairs import (
    CellRepair,
    one_factor_repairs,
    one_row_repairs,
    repaired_row,
    repaired_values,
    repairs_by_axes,
    reversed_factors,
    two_factor_repairs,
)

# --- Find the valid table nearest to a submitted table


@dataclass(frozen=True, slots=True)
class NearestTable:
    """The table that describes the robot and is nearest to the submitted table.

    ``frames`` ``(joints, samples, 4, 4)`` are the valid table's frames on the joint axes, as seen
    from the reference's frames. ``frame_choice`` explains ``cost``: the submitted table is valid if
    it is below 1. ``lost`` is the loss for the wrong cells: a single wrong cell loses one unit. It
    is computed for the valid table with the smallest loss (not always this table), and infinite if
    unknown.
    """

    roles: tuple[Role, ...]
    expected: Table
    frames: Matrices
    cost: float
    lost: float = np.inf


def nearest_for_roles(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """Return the valid table nearest to rows whose joints are known."""
    if freedom == FrameFreedom() and all(role.row is not None for role in roles):
        nearest = nearest_by_few_cells(roles, convention, grading)
        nearest = nearest or _as_intended(roles, convention, freedom, grading)
        if nearest is not None and 2 * WRONG_CELL < nearest.lost < np.inf:
            # Frames in which cells of several rows are wrong may lose less than a whole row.
            searched = _link_by_link(roles, convention, freedom, grading)
            nearest = replace(nearest, lost=min(nearest.lost, searched.lost))
        if nearest is not None:
            return nearest
    return _link_by_link(roles, convention, freedom, grading)


def _as_intended(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable | None:
    values = handed_in_values(roles)
    if not np.isfinite(values).all():
        return None
    exercise, samples = grading.exercise, grading.samples
    handed_in = written_table(values, convention, None, exercise.robot.joints, samples)
    for repaired in hypotheses_of(handed_in, Rereadable):
        table = repaired.answer
        [valid] = valid_tables(
            table.values[None], roles, table.convention, freedom, exercise, samples, INTENDED_POSE
        )
        intended = in_convention(table, convention) if valid else None
        if intended is not None:
            frames = frames_from_reference(intended, roles, convention, grading)
            changed = np.abs(intended - values).max(axis=-1) > UNCHANGED_CELL
            cost = WRONG_CELL * max(1, int(np.count_nonzero(changed)))
            return NearestTable(roles, intended, frames, cost)
    return None


def in_convention(table: WrittenTable, convention: Convention) -> Table | None:
    """Convert a table to a convention; return None if the table would get more or fewer rows."""
    links = regrouped(table.values, table.convention)
    left_out = links[0] if convention is Convention.STANDARD else links[-1, :2]
    return None if left_out.any() else as_table(links, convention)


def _link_by_link(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    # Try the table as written, then tables that differ in one cell, then a search along the links.
    exercise, samples = grading.exercise, grading.samples
    scale = exercise.length_scale
    mechanism = mechanism_at(exercise, samples)
    targets = targets_of(roles, convention, mechanism, freedom)
    rows = row_constants(roles, exercise.robot.joints, convention, samples)
    match = _as_written(rows, targets, roles, mechanism, freedom, scale)
    if match is None and freedom != FrameFreedom() and all(role.row for role in roles):
        match = one_cell_match(rows, targets, roles, convention, freedom, grading)
    # The cell may be the only wrong one in these frames, and its row may lose less in other frames.
    if match is None or match.cost > WRONG_CELL:
        searched = _searched(rows, targets, roles, convention, mechanism, freedom, scale)
        lost = searched.lost if match is None else min(match.lost, searched.lost)
        match = replace(match or searched, lost=lost)
    # Each cell should be its constant plus its joint variable.
    expected = np.tile(as_table(match.rows, convention), 2)
    for (i, column), joint in joint_cells(roles).items():
        sign = (freedom.directions and rows[i + 1].joint_sign) or match.joint_signs[i]
        expected[i, column] += sign * samples.values[joint.variable]
    frames = frames_on_axes(match.relative_poses, match.rows, roles, convention, mechanism)
    lost = match.lost
    if lost > WRONG_CELL and freedom != FrameFreedom():
        spoiled = with_spoiled_row(roles, expected, scale)
        if spoiled is not None:
            rows = row_constants(spoiled, exercise.robot.joints, convention, samples)
            searched = _searched(rows, targets, roles, convention, mechanism, freedom, scale)
            lost = min(lost, searched.lost)
    return NearestTable(roles, expected, frames, match.cost, lost)


def _as_written(
    rows: list[RowConstants],
    targets: list[Target],
    roles: tuple[Role, ...],
    mechanism: Mechanism,
    freedom: FrameFreedom,
    scale: float,
) -> ChainMatch | None:
    written = np.array([row.written for row in rows])
    signs = np.array([row.joint_sign for row in rows])
    for base in possible_bases(written, signs, roles, mechanism, freedom):
        match = match_as_written(
            rows, targets, scale, directions_given=not freedom.directions, start=base
        )
        if match is not None:
            return match
    return None


def _searched(
    rows: list[RowConstants],
    targets: list[Target],
    roles: tuple[Role, ...],
    convention: Convention,
    mechanism: Mechanism,
    freedom: FrameFreedom,
    scale: float,
) -> ChainMatch:
    # Seen from the tool, the two halves of a row are in the opposite order.
    is_seen_from_tool = freedom.base and not freedom.tool
    search = partial(
        nearest_table,
        length_scale=scale,
        directions_given=not freedom.directions,
        z_ends_rows=(convention is Convention.MODIFIED) != is_seen_from_tool,
    )
    if not freedom.base:
        return search(rows, targets)
    if freedom.tool:
        match = search(rows, targets, base_given=False)
        if match.cost >= WRONG_CELL:
            return match
    else:
        seen_from_tool = reversed_targets(targets, mechanism.offsets)
        match = search(reversed_rows(rows), seen_from_tool)
        match = replace(match, rows=-reversed_cells(match.rows))
    signs = np.array([row.joint_sign for row in rows])
    bases = possible_bases(match.rows, signs, roles, mechanism, freedom)
    if freedom.tool:
        return min((search(rows, targets, start=base) for base in bases), key=lambda m: m.cost)
    [base] = bases
    _, poses = match_tables(match.rows[None], 0 * signs[None], targets, scale, start=base)
    return replace(match, relative_poses=poses[:, 0])


def parallel_neighbours(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> NDArray[np.bool_]:
    """Return a mask ``(rows,)`` of the rows whose axis is parallel to a neighbouring axis.

    Offsets along parallel axes add up.
    """
    reference = reference_frames(grading.exercise, convention, grading.samples)
    axes = reference[:, :2, :3, 2]
    parallel = np.abs(cross(axes[:-1], axes[1:])).max(axis=(1, 2)) < PARALLEL
    # The tool's axis counts only if the d of some row lies along it.
    parallel[-1] &= roles[-1].joint is None
    of_joints = iter((parallel | np.append(False, parallel[:-1])).tolist())
    return np.array([role.joint is not None and next(of_joints) for role in roles])


# --- Find the valid table that differs from a submitted one in at most two cells or one row
#
# Base, tool and directions are given here, so the right value of a cell follows from all others: a
# table is valid if its tool pose equals that of the reference at all joint values, and every cell
# changes only as its own joint variable does.


# The number of samples at which repairs are searched; their values are then computed at all
# samples.
FEW_CELLS_SUBSET = 3
SUBSET_SAMPLES = np.r_[:FEW_CELLS_SUBSET, HALF : HALF + FEW_CELLS_SUBSET]
MAX_CELLS = 2
# The discount of two wrong cells in one row against two in several rows, if the frames are the
# reference's.
IN_ONE_ROW = 0.3
# The cost of a repair that changes unread cells only: the table may be right.
UNREAD = WRONG_CELL / 10


@dataclass(frozen=True, slots=True)
class _FewCellsCase:
    """A table ``(rows, 4, samples)`` to be repaired.

    ``variables`` has the joint variable that belongs in each cell, or 0. ``wrong`` has the indices
    of the cells that change with the joints in another way.
    """

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
        return _from_reference(reached, self.roles, self.convention, self.grading)


def nearest_by_few_cells(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> NearestTable | None:
    """Return the valid table that differs from the submitted one in at most two cells or one row.

    Of several such tables, the one with the likeliest mistake is taken. No row may be missing.
    """
    case = _few_cells_case(roles, convention, grading)
    if len(case.wrong) > MAX_CELLS and len({row for row, _ in case.wrong}) > 1:
        return None
    if not case.wrong:
        reached = frames(case.table, convention)
        if np.abs(_in_unit(reached[-1] - case.reference[-1], case.unit)).max() < SAME_POSE:
            on_axes = case.from_reference(reached[:, None, SUBSET_SAMPLES])
            return NearestTable(roles, case.table, on_axes[:, 0], 0.0)
    repairs = _few_cells_repairs(case)
    nearest = _few_cells_likeliest(repairs, case) if repairs else None
    if nearest is None:
        return None
    return replace(nearest, lost=min(_units_lost_by(repair, case) for repair in repairs))


def single_repairs(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> frozenset[CellIndex]:
    """Return the cells of which each, if corrected alone, makes the table describe the robot.

    Every row and every cell must have a value.
    """
    case = _few_cells_case(roles, convention, grading)
    factors = factors_of(case.table[..., SUBSET_SAMPLES], case.convention, case.unit)
    pose = _in_unit(case.reference[-1, SUBSET_SAMPLES], case.unit)
    repairs = _admissible(one_factor_repairs(factors, pose), [1], case)
    return frozenset(cell for repair in repairs for cell in repair.cells)


def frames_from_reference(
    table: Table, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Matrices:
    """Return a table's frames on the joint axes, relative to the reference frames.

    The shape is ``(joints, samples, 4, 4)``, at a subset of the samples.
    """
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


def _few_cells_case(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> _FewCellsCase:
    table = handed_in_values(roles)
    finite = np.isfinite(table).all(axis=-1)
    table[~finite] = 0.0
    variables = variables_of(roles, grading.samples)
    right = finite & moves_with(table, changes(variables), IS_ANGLE[:, None])
    places = [] if right.all() else np.argwhere(~right).tolist()
    wrong = frozenset((i, column) for i, column in places)
    return _FewCellsCase(roles, table, variables, wrong, convention, grading)


def _few_cells_repairs(case: _FewCellsCase) -> list[CellRepair]:
    factors = factors_of(case.table[..., SUBSET_SAMPLES], case.convention, case.unit)
    pose = _in_unit(case.reference[-1, SUBSET_SAMPLES], case.unit)
    by_factor = one_factor_repairs(factors, pose)
    if by_one_cell := _admissible(by_factor, [1], case):
        return by_one_cell
    by_two_cells = chain(by_factor, two_factor_repairs(factors, pose))
    by_row = one_row_repairs(factors, pose, case.wrong)
    return [*_admissible(by_two_cells, [2], case), *_admissible(by_row, [3, 4], case)]


def _admissible(
    repairs: Iterable[CellRepair], counts: Container[int], case: _FewCellsCase
) -> list[CellRepair]:
    # The number of cells of a repair must be in ``counts``; lengths are returned in the table's
    # unit.
    of_count = (_in_table_unit(repair, case) for repair in repairs if len(repair.cells) in counts)
    return [
        repair
        for repair in of_count
        if case.wrong <= set(repair.cells) and _moves_rightly(repair, case, slice(FEW_CELLS_SUBSET))
    ]


def _few_cells_likeliest(repairs: Sequence[CellRepair], case: _FewCellsCase) -> NearestTable | None:
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
        table = _few_cells_repaired(cells, factors, case)
        if table is None:
            continue
        if len(repairs) > 1:
            cost += sum(_penalty(cell, table, case) for cell in cells)
        if best is None or cost < best.cost:
            best = NearestTable(case.roles, table, on_axes[:, k], cost)
    return best


def _units_lost_by(repair: CellRepair, case: _FewCellsCase) -> float:
    if len(repair.cells) == 1:
        return WRONG_CELL
    repaired = case.table[..., SUBSET_SAMPLES].copy()
    _fill(repaired, repair)
    wrong = np.zeros(repaired.shape[:2], np.bool_)
    wrong[tuple(np.array(repair.cells).T)] = True
    return units_lost(repaired, case.variables[..., SUBSET_SAMPLES], wrong, case.unit)


def _base_cost(repair: CellRepair, departures: float, case: _FewCellsCase) -> float:
    # ``departures`` is the cost of the frames.
    rows = [role.row for role in case.roles]
    if all((row := rows[i]) and not row.entries[c].readable for i, c in repair.cells):
        return UNREAD
    if len(repair.cells) == 1:
        return WRONG_CELL
    is_preferred = not departures and len({row for row, _ in repair.cells}) == 1
    return WRONG_CELL * len(repair.cells) - IN_ONE_ROW * is_preferred


def _penalty(cell: CellIndex, repaired: Table, case: _FewCellsCase) -> float:
    right = _constant(repaired[cell], cell, case)
    written = None if cell in case.wrong else _constant(case.table[cell], cell, case)
    return slip_penalty(written, right, bool(IS_ANGLE[cell[1]]), case.grading)


def _constant(values: Numbers, cell: CellIndex, case: _FewCellsCase) -> Numbers:
    # The values must be a constant, plus or minus the joint variable that belongs in the cell.
    variable: Numbers = case.variables[cell]
    error = np.abs(difference(changes(values), changes(variable), IS_ANGLE[cell[1]]))
    return values - variable if error.max() < SAME_MOTION else values + variable


def _few_cells_repaired(
    cells: Sequence[CellIndex], factors: Factors, case: _FewCellsCase
) -> Table | None:
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


def _moves_rightly(repair: CellRepair, case: _FewCellsCase, samples: slice) -> bool:
    return all(
        moves_with(value, changes(case.variables[cell])[samples], IS_ANGLE[cell[1]])
        for cell, value in zip(repair.cells, repair.values, strict=True)
    )


def _fill(table: Table, repair: CellRepair) -> None:
    for cell, value in zip(repair.cells, repair.values, strict=True):
        table[cell] = value


def _in_table_unit(repair: CellRepair, case: _FewCellsCase) -> CellRepair:
    units = [[1.0 if IS_ANGLE[column] else case.unit] for _, column in repair.cells]
    return CellRepair(repair.cells, repair.values * np.array(units))


def _in_unit(pose: Matrices, unit: float) -> Matrices:
    measured = pose.copy()
    measured[..., :3, 3] /= unit
    return measured


# --- Find the valid table that differs from a submitted one in one cell, if frames may be chosen
#
# The joint axes of a valid table, with all joints at 0, must lie on those of the reference table.
# The axes give the value that each cell would need if no other cell were wrong
# (``repairs_by_axes``). All repaired tables are then tested at once.
#
# ``nearest_by_few_cells`` compares poses at all joint values, which is impossible if the student
# chooses base, tool or directions.


# The number of samples at which repairs are searched; their values are then computed at all
# samples.
ONE_CELL_SUBSET = 2


@dataclass(frozen=True, slots=True)
class _Repair:
    """A repair of one cell by a new constant, with the pose of one end of the chain after it.

    The end is the last frame if ``is_last`` is true, else frame 0. Its pose ``(L, 4, 4)`` is in the
    reference's frame 0. ``attempt`` is the index of the assumption on which the repair is based.
    """

    cell: CellIndex
    value: Numbers
    end: Matrices
    is_last: bool
    attempt: int


@dataclass(frozen=True, slots=True)
class _Body:
    """A table as a product of factors, and the reference's axes in the same order.

    ``joints`` ``(n,)`` are the indices of the factors that a joint moves. ``axes`` ``(n, L, 4, 4)``
    are the correct poses of the joint axes in the reference's frame 0. ``is_reversed`` is true if
    the factors start from the last frame instead of frame 0.
    """

    factors: Factors
    joints: Integers
    axes: Matrices
    sliding: NDArray[np.bool_]
    is_reversed: bool = False

    @property
    def reversed(self) -> "_Body":
        return _Body(
            reversed_factors(self.factors),
            len(self.factors.axes) - 1 - self.joints[::-1],
            self.axes[::-1],
            self.sliding[::-1],
            is_reversed=True,
        )

    def cell(self, k: int, kind: int) -> CellIndex:
        in_table = len(self.factors.axes) - 1 - k if self.is_reversed else k
        return in_table // 2, (A if self.factors.axes[k] == X else D) + kind

    def factor(self, cell: CellIndex) -> int:
        in_table = self.factors.position(cell)[0]
        return len(self.factors.axes) - 1 - in_table if self.is_reversed else in_table


@dataclass(frozen=True, slots=True)
class _OneCellCase:
    """A table ``(rows, 4, L)`` of constants to be repaired, and the robot of the reference table.

    ``wrong`` are the cells that are wrong whatever frames are chosen. ``joint_signs`` ``(rows +
    1,)`` are the signs of the joint variables, 0 if irrelevant.
    """

    table: Table
    wrong: frozenset[CellIndex]
    joint_signs: Integers
    roles: tuple[Role, ...]
    convention: Convention
    freedom: FrameFreedom
    mechanism: Mechanism
    targets: Sequence[Target]
    length_scale: float

    def body(self, samples: int) -> tuple[_Body, Matrices]:
        # The table and the reference's last frame, both at the first ``samples``.
        factors = factors_of(self.table[..., :samples], self.convention)
        joints = joint_cells(self.roles)
        axes = np.array(list(accumulate(self.mechanism.joints[:, :samples], np.matmul)))
        body = _Body(
            factors,
            np.array([factors.position((i, D))[0] for i, _ in joints]),
            axes,
            np.array([joint.prismatic for joint in joints.values()]),
        )
        return body, axes[-1] @ self.mechanism.tool[:samples]


@dataclass(frozen=True, slots=True)
class _Repaired:
    """T repairs after which the table describes the robot, and the repaired tables.

    ``links`` is ``(T, rows + 1, 4, L)``; ``poses`` ``(rows + 1, T, L, 4, 4)`` are the relative
    poses of the repaired tables.
    """

    repairs: Sequence[_Repair]
    links: Numbers
    poses: Matrices


def one_cell_match(
    rows: Sequence[RowConstants],
    targets: Sequence[Target],
    roles: tuple[Role, ...],
    convention: Convention,
    freedom: FrameFreedom,
    grading: Grading,
) -> ChainMatch | None:
    """Return the table that describes the robot after the repair of one cell, or None.

    Of several repairs, the likeliest is taken. No row may be missing.
    """
    wrong = np.array([row.wrong_regardless | ~(row.is_gradable | row.absent) for row in rows])
    wrong_cells = np.argwhere(as_table(wrong, convention)).tolist()
    if len(wrong_cells) > 1:
        return None
    case = _OneCellCase(
        np.nan_to_num(as_table(np.array([row.written for row in rows]), convention)),
        frozenset((i, column) for i, column in wrong_cells),
        np.array([0 if freedom.directions else row.joint_sign for row in rows]),
        roles,
        convention,
        freedom,
        mechanism_at(grading.exercise, grading.samples),
        targets,
        grading.exercise.length_scale,
    )
    found = _one_cell_repaired(case, list(_one_cell_repairs(case, ONE_CELL_SUBSET)))
    if found.repairs:
        attempts = {(repair.attempt, repair.cell) for repair in found.repairs}
        found = _one_cell_repaired(
            case, list(_one_cell_repairs(case, case.table.shape[-1], attempts))
        )
    if case.wrong:
        # Prefer 0 as the constant beside a wrong joint variable: it does not imply other frames.
        without = _one_cell_repaired(case, [replace(r, value=0 * r.value) for r in found.repairs])
        found = without if without.repairs else found
    return _one_cell_likeliest(found, case, grading) if found.repairs else None


def _one_cell_likeliest(found: _Repaired, case: _OneCellCase, grading: Grading) -> ChainMatch:
    # A repair is likely if it leads to frames near the reference's frames, and if students often
    # make the mistake.
    links = np.moveaxis(found.links, 0, 2)
    frames = frames_on_axes(found.poses, links, case.roles, case.convention, case.mechanism)
    departures = departure(frames.reshape(-1, *frames.shape[2:]), case.length_scale)
    costs = WRONG_CELL + departures.reshape(frames.shape[:2]).sum(axis=0)
    if len(costs) > 1:
        for k, repair in enumerate(found.repairs):
            written = None if repair.cell in case.wrong else case.table[repair.cell]
            angle = bool(IS_ANGLE[repair.cell[1]])
            costs[k] += slip_penalty(written, repair.value, angle, grading)
    # If the constant needs no change, only the variable is wrong.
    unchanged = [np.array_equal(r.value, case.table[r.cell]) for r in found.repairs]
    of_variables = {r.cell for r in compress(found.repairs, unchanged)}
    for k, repair in enumerate(found.repairs):
        if repair.cell in of_variables and not unchanged[k]:
            costs[k] = np.inf
    best = int(np.argmin(costs))
    return ChainMatch(found.links[best], found.poses[:, best], float(costs[best]), WRONG_CELL)


def _one_cell_repaired(case: _OneCellCase, repairs: Sequence[_Repair]) -> _Repaired:
    if not repairs:
        return _Repaired((), np.empty(0), np.empty(0))
    samples = len(repairs[0].value)
    tables = np.repeat(case.table[None, ..., :samples], len(repairs), axis=0)
    signs = np.repeat(case.joint_signs[None], len(repairs), axis=0)
    variables = joint_cells(case.roles)
    for k, repair in enumerate(repairs):
        tables[k][repair.cell] = repair.value
        if repair.cell in variables:
            signs[k, repair.cell[0] + 1] = 0
    links = np.moveaxis(regrouped(np.moveaxis(tables, 0, 2), case.convention), 2, 0)
    starts = _starts(repairs, tables, case.convention)
    valid, poses = match_tables(links, signs, case.targets, case.length_scale, start=starts)
    chosen = [repairs[k] for k in np.flatnonzero(valid).tolist()]
    return _Repaired(chosen, links[valid], poses[:, valid])


def _starts(repairs: Sequence[_Repair], tables: Numbers, convention: Convention) -> Matrices:
    # The pose ``(T, L, 4, 4)`` of frame 0 of each table in the reference's frame 0.
    starts = np.array([repair.end for repair in repairs])
    from_last = np.array([repair.is_last for repair in repairs])
    if from_last.any():
        starts[from_last] @= inverse(pose(np.moveaxis(tables[from_last], 0, 2), convention))
    return starts


def _one_cell_repairs(
    case: _OneCellCase, samples: int, attempts: Set[tuple[int, CellIndex]] | None = None
) -> Iterator[_Repair]:
    # The values are those that each cell would need if no other cell were wrong. If ``attempts``
    # are given, yield only the repairs of these attempts and cells.
    body, tool = case.body(samples)
    for attempt, (seen, ends) in enumerate(_ends(body, tool, case.freedom)):
        if attempts is not None and all(attempt != wanted for wanted, _ in attempts):
            continue
        for cell, value in _values(seen, ends, tool, case):
            if case.wrong <= {cell} and (attempts is None or (attempt, cell) in attempts):
                end = ends[seen.factor(cell)]
                yield _Repair(cell, value, end, seen.is_reversed, attempt)


def _values(
    body: _Body, ends: Matrices, tool: Matrices, case: _OneCellCase
) -> Iterator[tuple[CellIndex, Numbers]]:
    if case.freedom.base or case.freedom.tool:
        starts = ends @ body.factors.before[:-1]
        sign = -1.0 if body.is_reversed else 1.0
        for k, kind, value in repairs_by_axes(
            body.factors, starts, body.joints, body.axes, body.sliding
        ):
            yield body.cell(k, kind), sign * value
    else:
        for repair in one_factor_repairs(body.factors, tool):
            if len(repair.cells) == 1:
                yield repair.cells[0], repair.values[0]
    # The constant may be right and the variable wrong.
    for cell in joint_cells(case.roles):
        yield cell, case.table[cell][: len(tool)]


def _ends(body: _Body, tool: Matrices, freedom: FrameFreedom) -> Iterator[tuple[_Body, Matrices]]:
    # The poses ``(K, L, 4, 4)`` are in the reference's frame 0. Pose k is correct if only factor k
    # of the table is wrong.
    count = len(body.factors.axes)
    if not freedom.base:
        yield body, identity((count, len(tool)))
    elif not freedom.tool:
        yield body.reversed, np.repeat(tool[None], count, axis=0)
    else:
        for seen in (body, body.reversed):
            for ends in _ends_by_axes(seen):
                yield seen, ends


def _ends_by_axes(body: _Body) -> Iterator[Matrices]:
    # The student's axes are put on the reference's axes.
    n, samples = body.axes.shape[:2]
    on_axes = body.factors.before[body.joints]
    # A variable may be the wrong cell, or have either sign. The first axis and the next one that is
    # not parallel to it determine the orientation of the end.
    directions = [np.array([z, *[x] * (n - 1)]) for z, x in product((1, -1), repeat=2)]
    source = np.concatenate([directed(on_axes, signs) for signs in directions], axis=1)
    target = np.concatenate([body.axes] * len(directions), axis=1)
    aligned = align_first_axes(source, target, body.sliding)
    before = np.searchsorted(body.joints, np.arange(len(body.factors.axes)), side="right")
    for i in range(len(directions)):
        yield aligned[np.maximum(before, 1) - 1, i * samples : (i + 1) * samples]


# --- Replace the only wrong row of a table by numbers that are wrong in every cell
#
# A wrong row can mislead the search for the student's frames, so that correct rows look wrong.


# The fractional parts of its multiples are not angles or lengths of any robot.
OUT_OF_PLACE: Final = 0.3819660112501051


def out_of_place(rows: int, length_scale: float) -> Table:
    """Return numbers ``(rows, 4, 1)`` that are wrong in every cell of a table."""
    count = rows * len(IS_ANGLE)
    numbers = (OUT_OF_PLACE * np.arange(1, count + 1)) % 1 + OUT_OF_PLACE
    scales = np.where(IS_ANGLE, 1.0, length_scale)
    return np.asarray(numbers.reshape(rows, -1, 1) * scales[:, None])


def with_spoiled_row(
    roles: tuple[Role, ...], expected: Table, length_scale: float
) -> tuple[Role, ...] | None:
    """Replace the only row that differs from ``expected`` by wrong numbers.

    Return None if several rows differ, if the row is missing, or if it was replaced before.
    """
    handed_in, scales = handed_in_values(roles), np.where(IS_ANGLE, 1.0, length_scale)
    right = nearly_equal(handed_in, expected, scales, IS_ANGLE[:, None]).all(axis=1)
    wrong = np.flatnonzero(~right).tolist()
    if len(wrong) != 1:
        return None
    [i] = wrong
    row = roles[i].row
    if row is None or row.is_given_up:
        return None
    numbers = np.broadcast_to(out_of_place(len(roles), length_scale), handed_in.shape)
    spoiled = Role(computed_row(numbers[i], GIVEN_UP), roles[i].joint)
    return (*roles[:i], spoiled, *roles[i + 1 :])


# --- Estimate the loss of points for wrong cells


def units_lost(
    expected: Table, variables: Table, wrong: NDArray[np.bool_], length_scale: float
) -> float:
    """Return the estimated loss for the ``wrong`` cells; a single wrong cell costs 1.

    Several wrong cells in one row lose no more than the row is worth. ``expected`` ``(rows, 4,
    samples)`` is the correct table. ``variables`` is the joint variable that belongs in each cell,
    or 0.
    """
    either = np.array([expected - variables, expected + variables])
    error = np.abs(difference(either, np.zeros(1), IS_ANGLE[:, None])).max(axis=-1).min(axis=0)
    known = error > SAME_CONTENT * np.where(IS_ANGLE, 1.0, length_scale)
    worth, count = BESIDES + known.sum(axis=1), wrong.sum(axis=1)
    return float(np.where(count > 1, np.minimum(worth, count), count).sum())


# --- Find the likeliest of several mistakes that each explain a wrong table
#
# On parallel axes, and around prismatic joints, a mistake can often be repaired in several cells. A
# mistake is likely if the correct value is simple, or if students often make it: a wrong sign, a
# forgotten value, a quarter turn, an extra term, a missing or misplaced joint variable.


# All these costs are far below that of a wrong cell; an unknown slip costs less than a moved frame.
TERM = 0.002
UNKNOWN_SLIP = 0.010

# The number of terms of a constant that is not a sum of letters and a number.
UNRELATED = 4


def slip_penalty(written: Numbers | None, right: Numbers, angle: bool, grading: Grading) -> float:
    """Return how unlikely it is to write one constant for another; at least 0.

    ``written`` is None if the cell is unreadable, or if the mistake is in its joint variable.
    """
    right_terms = _terms(right, angle, grading)
    penalty = TERM * _count(right_terms)
    if written is None or _is_turn(written, right, angle):
        return penalty
    terms = _terms(written, angle, grading)
    if terms == {} or _count(terms) > _count(right_terms):
        return penalty
    if terms is not None and right_terms is not None and _sizes(terms) == _sizes(right_terms):
        return penalty
    return penalty + UNKNOWN_SLIP


def _is_turn(written: Numbers, right: Numbers, angle: bool) -> bool:
    if not angle:
        return False
    turns = [written - right + turn for turn in (np.pi / 2, np.pi, -np.pi / 2)]
    error = np.abs(difference(np.array([*turns, written + right]), np.zeros(1), angle))
    return bool(error.max(axis=-1).min() < SAME_TERM)


# The multiple of each letter; the number has the key "".
_Terms = dict[str, float]


def _terms(constant: Numbers, angle: bool, grading: Grading) -> _Terms | None:
    # A sum of letters and a number; quarter turns are left out.
    found = multiples(constant[:HALF], angle, grading.exercise, grading.samples)
    if found is None:
        return None
    letters, number = found
    if angle:
        number -= np.pi / 2 * round(number / (np.pi / 2))
    rest = {"": float(number)} if abs(number) > SAME_TERM else {}
    return {letter: float(share) for share, letter in letters} | rest


def _count(terms: _Terms | None) -> float:
    # 2*l1 counts as two terms.
    if terms is None:
        return UNRELATED
    return sum(abs(share) if letter else 1.0 for letter, share in terms.items())


def _sizes(terms: _Terms) -> dict[str, float]:
    return {letter: round(abs(share), 6) for letter, share in terms.items()}
