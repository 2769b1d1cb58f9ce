"""Choose the joint of each submitted row; find what unread cells and rounded decimals may be.

This file knows tables as wholes: whether their rows, with some joints, values and decimals, can
describe the robot. What a single wrong cell loses is known to ``nearest.py``.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Joint
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.grading.frames import (
    FrameFreedom,
    Role,
    freedom_of,
    handed_in_values,
    joint_cells,
    known_angles,
    mechanism_at,
    possible_bases,
    regrouped,
    roles_of,
    row_constants,
    targets_of,
    tool_pose,
    with_exact_angles,
)
from dh_grader.grading.frames.nearest import NearestTable, frames_from_reference, nearest_for_roles
from dh_grader.grading.judging import Grading
from dh_grader.grading.numbers import (
    EXACT_VALUE,
    HALF,
    SAMPLES,
    Samples,
    SharedDecimals,
    difference_steps,
    fitted_unknowns,
    nearly_equal,
)
from dh_grader.grading.reading.table import IS_ANGLE, StudentRow
from dh_grader.grading.report import WorkBudget
from dh_grader.kinematics import (
    COLUMNS,
    SAME_POSE,
    A,
    CellIndex,
    Convention,
    D,
    Matrices,
    Numbers,
    Table,
    cross,
    exponential,
    frames,
    identity,
    pose,
    rot_x,
    rot_y,
    rot_z,
)
from dh_grader.kinematics.frame_choice import WRONG_CELL, Target, match_tables, misfits

# --- Choose which joint each submitted row belongs to


def best_roles(
    part: DhTableSpec, rows: tuple[StudentRow, ...], convention: Convention, grading: Grading
) -> tuple[tuple[Role, ...], NearestTable]:
    """Return each row with its joint, and the nearest table that describes the robot."""
    freedom = freedom_of(part)
    roles, nearest = _best_as_written(rows, convention, freedom, grading)
    return roles, with_rounded_cells(nearest, convention, freedom, grading)


def _best_as_written(
    rows: tuple[StudentRow, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> tuple[tuple[Role, ...], NearestTable]:
    joints = grading.exercise.robot.joints
    roles = roles_in(rows, convention, grading)
    roles = with_true_numbers(roles, convention, freedom, grading)
    nearest = nearest_with_tool_row(roles, convention, freedom, grading)
    if nearest.cost < WRONG_CELL:
        return roles, nearest
    other, price = None, 0.0
    if len(nearest.roles) < len(rows):
        # The row of zeros that was left out may belong to a joint.
        other = roles_in(rows, convention, grading, expected_rows=len(rows))
    elif len(rows) == len(joints) and len(rows) < usual_rows(convention, grading):
        # The missing row need not be the last.
        other, price = roles_in(rows, convention, grading, in_order=False), WRONG_CELL
    elif len(rows) > len(joints):
        # A joint's row may look like a fixed row because its variable is wrong.
        other = roles_in(rows, convention, grading, in_order=True)
    if other is None or _pairing(other) == _pairing(roles):
        return roles, nearest
    found = nearest_for_roles(other, convention, freedom, grading)
    lost = min(found.lost, nearest.lost)
    if found.cost + price < nearest.cost:
        return other, replace(found, lost=lost)
    return roles, replace(nearest, lost=lost)


def roles_in(
    rows: tuple[StudentRow, ...],
    convention: Convention,
    grading: Grading,
    expected_rows: int | None = None,
    *,
    in_order: bool | None = None,
) -> tuple[Role, ...]:
    """Return each submitted row with its joint, and with rounded angles made exact.

    ``in_order`` is true if the rows are in the order of the joints, None if unknown.
    """
    expected_rows = expected_rows or usual_rows(convention, grading)
    rows = without_idle_rows(rows, expected_rows)
    joints = grading.exercise.robot.joints
    roles = roles_of(rows, joints, grading.samples, expected_rows, in_order=in_order)
    return with_exact_angles(roles, grading.exercise, grading.samples)


def nearest_with_tool_row(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """Return the valid table nearest to the rows, which may lack the row of the tool."""
    nearest = nearest_for_roles(roles, convention, freedom, grading)
    if nearest.cost < WRONG_CELL or len(roles) >= usual_rows(convention, grading):
        return nearest
    longer = nearest_for_roles((*roles, Role(None, None)), convention, freedom, grading)
    is_longer = longer.cost + WRONG_CELL <= nearest.cost
    return replace(longer if is_longer else nearest, lost=min(longer.lost, nearest.lost))


def without_idle_rows(rows: tuple[StudentRow, ...], expected_rows: int) -> tuple[StudentRow, ...]:
    """Return the rows without extra rows at the end that move nothing."""
    while len(rows) > expected_rows and rows[-1].is_zero:
        rows = rows[:-1]
    return rows


def rows_of_mechanism(
    rows: tuple[StudentRow, ...], convention: Convention, grading: Grading
) -> list[int]:
    """Return the indices of the rows that belong to the robot, without extra rows.

    The choice depends only on the joint variables in the rows, not on what is correct.
    """
    usual, joints = usual_rows(convention, grading), grading.exercise.robot.joints
    if len(rows) <= usual:
        return list(range(len(rows)))
    roles = [role for role in roles_of(rows, joints, grading.samples, usual) if role.row]
    last = max((i for i, role in enumerate(roles) if role.joint), default=-1)
    of_joints = [i for i, role in enumerate(roles) if role.joint]
    return [*of_joints, *range(last + 1, len(roles))[: usual - len(joints)]]


def usual_rows(convention: Convention, grading: Grading) -> int:
    """Return the number of rows that a table of this robot usually has."""
    robot = grading.exercise.robot
    reference = robot.tables.get(convention)
    return len(robot.joints if reference is None else reference.rows)


def _pairing(roles: Sequence[Role]) -> list[tuple[Joint | None, bool]]:
    return [(role.joint, role.row is None) for role in roles]


# --- Search for values of a table's unreadable cells with which the table describes the robot
#
# If such values exist, no other cell is wrong. The value of an unread cell is a constant, or a
# constant plus or minus the joint variable that belongs in the cell.
#
# The method is Newton's with damping (Levenberg and Marquardt), from many starts. Shapes: S starts,
# L joint values, U unknowns (the unread cells, and the pose of a base or tool that the student
# chose).


STARTS, POSTURES, STEPS = 32, 6, 25
# The number of steps after which only the best starts continue.
SIFTED_AT, KEPT = 8, 12
# From this step on, the search ends if no start can reduce its error by this share in one step: all
# are near local minima. None of 185 successful searches came below a half.
PATIENCE, LEAST_PROMISE = 5, 0.3
# The work of the start, of a step, and of each unknown of each start in a step.
START_WORK, STEP_WORK, CELL_WORK = 10.0, 2.1, 0.014
# The largest difference of equal poses, in the exercise's typical length.
SAME = 1e-9
NO_SINE = 1e-12
_DAMPING = 1e-3
_LEAST_DAMPING = 1e-12


@dataclass(frozen=True)
class _Case:
    """A table with unread cells at one set of link lengths; the unit is the typical length.

    ``table`` is ``(rows, 4, L)`` with 0 in the ``unread`` cells ``(U, 2)``. ``variables`` ``(U,
    L)`` is the joint variable that belongs in each unread cell. ``target`` ``(L, 4, 4)`` are the
    tool frames of the reference.
    """

    table: Table
    unread: NDArray[np.int_]
    variables: Numbers
    target: Matrices
    convention: Convention
    freedom: FrameFreedom

    @cached_property
    def axes(self) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
        # The frame and the axis (z or x) along which each unread cell acts.
        rows, columns = self.unread.T
        about_z = columns >= D
        first = about_z == (self.convention is Convention.STANDARD)
        return np.where(first, rows, rows + 1), np.where(about_z, 2, 0)

    @cached_property
    def slides(self) -> NDArray[np.bool_]:
        # The unknowns are the unread cells, then the twists of a free base and of a free tool.
        twists = self.freedom.base + self.freedom.tool
        return np.concatenate([~IS_ANGLE[self.unread[:, 1]], *[np.arange(6) >= 3] * twists])


def completed(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable | None:
    """Return the table if some values in its unreadable cells make it describe the robot.

    Return None if there are no such values. They are not unique, so the result has 0 in the
    unreadable cells, and the frames of the reference. The directions of the joint axes count as
    given.
    """
    if any(role.row is None for role in roles):
        return None
    case = _case(roles, convention, freedom, grading)
    if not len(case.unread) or not _can_be_completed(case, grading.reader.budget):
        return None
    values = handed_in_values(roles)
    expected = np.where(np.isfinite(values).all(axis=-1, keepdims=True), values, 0.0)
    nowhere = identity((len(grading.exercise.joints), 2))
    return NearestTable(roles, expected, nowhere, WRONG_CELL / 2)


def _case(
    roles: Sequence[Role], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> _Case:
    exercise = grading.exercise
    samples = _of_one_robot(grading.samples, [joint.variable for joint in exercise.joints])
    table = np.array([_values_at(role, samples) for role in roles])[..., :POSTURES]
    finite = np.isfinite(table).all(axis=-1)
    unread = np.argwhere(~finite)
    table[~finite] = 0.0
    table[:, [A, D]] /= exercise.length_scale
    joints = joint_cells(roles)
    variables = np.zeros((len(unread), POSTURES))
    for k, (row, column) in enumerate(unread.tolist()):
        if (cell := (row, column)) in joints:
            unit = 1.0 if IS_ANGLE[column] else exercise.length_scale
            variables[k] = samples.values[joints[cell].variable][:POSTURES] / unit
    target = exercise.robot.frame("tool", samples.values, SAMPLES)[:POSTURES].copy()
    target[:, :3, 3] /= exercise.length_scale
    return _Case(table, unread, variables, target, convention, freedom)


def _of_one_robot(samples: Samples, joints: Sequence[str]) -> Samples:
    # All joint values, but the first link lengths at every sample.
    return Samples(
        {
            name: values if name in joints else np.full_like(values, values[0])
            for name, values in samples.values.items()
        }
    )


def _values_at(role: Role, samples: Samples) -> Table:
    assert role.row is not None
    made_exact = np.nan_to_num(role.row.values - role.row.handed_in)[:, :1]
    return np.asarray(role.row.values_at(samples) + made_exact)


def _can_be_completed(case: _Case, budget: WorkBudget) -> bool:
    if not budget.affords_search(START_WORK):
        return False
    rng = np.random.default_rng(HALF)
    count = len(case.unread)
    angle = IS_ANGLE[case.unread[:, 1]]
    # Start with multiples of a quarter turn, which most angles are near.
    constants = np.where(
        angle,
        rng.integers(-1, 3, (STARTS, count)) * np.pi / 2 + rng.normal(0, 0.2, (STARTS, count)),
        rng.normal(0, 1, (STARTS, count)),
    )
    signs = _signs([bool(variable.any()) for variable in case.variables])
    base, tool = _with_moved_ends(
        case.freedom,
        identity((STARTS, 1)),
        identity((STARTS, 1)),
        rng.normal(0, 1, (STARTS, 12)) * (np.arange(STARTS) % 2)[:, None],
    )
    damping = np.full(STARTS, _DAMPING)
    error, columns = _linearised(case, constants, signs, base, tool)
    for step in range(STEPS):
        size = (error**2).sum(axis=-1)
        if size.min() < SAME**2:
            return True
        if step == SIFTED_AT:
            kept = np.argsort(size, kind="stable")[:KEPT]
            constants, signs, base, tool, damping, error, columns, size = (
                each[kept] for each in (constants, signs, base, tool, damping, error, columns, size)
            )
        work = STEP_WORK + columns.shape[0] * columns.shape[1] * CELL_WORK
        if not budget.affords_search(work):
            return False
        change = _step(error, columns, damping)
        if step > PATIENCE and _promise(change, error, columns).max() < LEAST_PROMISE:
            return False
        tried = constants + change[:, :count]
        moved_base, moved_tool = _with_moved_ends(case.freedom, base, tool, change[:, count:])
        new_error, new_columns = _linearised(case, tried, signs, moved_base, moved_tool)
        better = (new_error**2).sum(axis=-1) < size
        damping = np.where(better, np.maximum(damping / 5, _LEAST_DAMPING), damping * 4)
        constants[better], error[better] = tried[better], new_error[better]
        columns[better] = new_columns[better]
        base[better], tool[better] = moved_base[better], moved_tool[better]
    return bool((error**2).sum(axis=-1).min() < SAME**2)


def _signs(holds_variable: Sequence[bool]) -> Numbers:
    # All combinations of signs, ``(S, U)``.
    signs = np.ones((STARTS, len(holds_variable)))
    places = [k for k, holds in enumerate(holds_variable) if holds]
    for bit, k in enumerate(places):
        signs[:, k] -= 2.0 * (np.arange(STARTS) >> bit & 1)
    return signs


def _linearised(
    case: _Case, constants: Numbers, signs: Numbers, base: Matrices, tool: Matrices
) -> tuple[Numbers, Numbers]:
    # The error ``(S, 6 L)`` is the rotation vector and the displacement from the tool at p to the
    # reference tool. Its derivative ``(S, U, …)`` for an angle is ω and ω × (p - point): a turn
    # about an axis with direction ω through the point. The derivative for a length is a shift along
    # the axis.
    starts, postures = len(constants), len(case.target)
    table = np.repeat(case.table[:, :, None], starts, axis=2)
    rows, columns = case.unread.T
    table[rows, columns] = constants.T[..., None] + signs.T[..., None] * case.variables[:, None]
    reached = base @ frames(table, case.convention)
    pose = reached[-1] @ tool
    of_cells, about = case.axes
    axes, points = [reached[of_cells, ..., :3, about]], [reached[of_cells, ..., :3, 3]]
    for is_free, frame in ((case.freedom.base, identity((1, 1))), (case.freedom.tool, pose)):
        if is_free:
            axes.append(np.moveaxis(np.tile(frame[..., :3, :3], 2), -1, 0))
            points.append(np.broadcast_to(frame[..., :3, 3], axes[-1].shape))
    shape = (starts, postures, 3)
    axis = np.concatenate([np.broadcast_to(each, (len(each), *shape)) for each in axes])
    point = np.concatenate([np.broadcast_to(each, (len(each), *shape)) for each in points])
    motion = np.zeros((*axis.shape[:-1], 6))
    motion[..., :3] = axis
    motion[..., 3:] = cross(axis, pose[..., :3, 3] - point)
    motion[case.slides, ..., :3], motion[case.slides, ..., 3:] = 0.0, axis[case.slides]
    error = np.empty((*shape[:2], 6))
    error[..., :3] = _rotation_vector(case.target[..., :3, :3] @ pose[..., :3, :3].swapaxes(-1, -2))
    error[..., 3:] = (case.target - pose)[..., :3, 3]
    return error.reshape(starts, -1), motion.reshape(len(motion), starts, -1).swapaxes(0, 1)


def _rotation_vector(rotation: Matrices) -> Numbers:
    # Axis times angle. The result is wrong for half a turn, which is far from any solution.
    upper, lower = (2, 0, 1), (1, 2, 0)
    twice_sine = rotation[..., upper, lower] - rotation[..., lower, upper]
    sine = np.sqrt((twice_sine**2).sum(axis=-1)) / 2
    angle = np.arctan2(sine, (np.trace(rotation, axis1=-2, axis2=-1) - 1) / 2)
    return np.asarray(twice_sine / 2 * (angle / np.maximum(sine, NO_SINE))[..., None])


def _step(error: Numbers, columns: Numbers, damping: Numbers) -> Numbers:
    # ``error`` is ``(S, E)``, ``columns`` ``(S, U, E)``, the step ``(S, U)``.
    square = columns @ columns.swapaxes(-1, -2)
    square += damping[:, None, None] * np.eye(columns.shape[1])
    return np.asarray(np.linalg.solve(square, columns @ error[..., None])[..., 0])


def _promise(change: Numbers, error: Numbers, columns: Numbers) -> Numbers:
    # The share ``(S,)`` of the squared error that a step removes, to first order.
    undone = (change * (columns @ error[..., None])[..., 0]).sum(axis=-1)
    return np.asarray(undone / (error**2).sum(axis=-1))


def _with_moved_ends(
    freedom: FrameFreedom, base: Matrices, tool: Matrices, twists: Numbers
) -> tuple[Matrices, Matrices]:
    # ``(S, 1, 4, 4)`` each.
    if freedom.base:
        base = exponential(twists[:, None, :6], 1.0) @ base
    if freedom.tool:
        tool = tool @ exponential(twists[:, None, -6:], 1.0)
    return base, tool


# --- Correct the rounding of all decimals of a table at once
#
# After that, the table describes the robot. Each decimal is shifted by at most a unit of its last
# place, so a less precise decimal cannot hide a wrong number. In a row of parallel axes it does not
# matter which offset was rounded.
#
# The errors of the chain (``frame_choice.misfits``) depend almost linearly on the shifts. The pose
# of a free base may change slightly, and the right value of a wrong cell is unknown. Both are
# unknowns, too.


# The number of sets of links needed to distinguish letters if only decimals are unknown.
LINKS = 6
# The unit of unknowns that are not shifts: an angle, or the same fraction of the typical length.
SMALL = 1e-2
TWIST = 6
# The most wrong cells that may have any value; with more, almost any table could be made to fit.
MOST_UNKNOWN = 6
# The size of a decimal without any effect, so that it is not 0.
LEAST_SIZE = 1e-16


@dataclass(frozen=True, slots=True)
class _Chain:
    """A table whose decimals are shifted until it describes the robot, at L sets of link lengths.

    ``links`` ``(rows + 1, 4, L)`` are the regrouped constants of the table; ``values`` ``(rows, 4,
    SAMPLES)`` are its cells. ``base`` ``(L, 4, 4)`` is the approximate pose of frame 0, or None if
    frame 0 is given. The ``unknown`` cells may have any value.
    """

    links: Table
    values: Table
    targets: Sequence[Target]
    base: Matrices | None
    unknown: Sequence[CellIndex]
    decimals: SharedDecimals
    convention: Convention
    length_scale: float

    @property
    def free(self) -> int:
        return len(self.unknown) + (TWIST if self.base is not None else 0)

    def misfits(self, shifts: Numbers, free: Numbers) -> Numbers:
        # ``shifts`` ``(K, count)`` are the shifts of the decimals, ``free`` ``(K, free, L)`` the
        # other unknowns; the errors are ``(K, n, L)``.
        count = self.links.shape[-1]
        cells = self.values.reshape(-1, SAMPLES)
        moved = (self.decimals.shifted(shifts, cells) - cells)[..., :count]
        moved = moved.reshape(len(shifts), *self.values.shape[:2], count)
        for i, (row, column) in enumerate(self.unknown):
            unit = SMALL if IS_ANGLE[column] else SMALL * self.length_scale
            moved[:, row, column] += unit * free[:, i]
        moved = np.moveaxis(regrouped(np.moveaxis(moved, 0, -1), self.convention), -1, 0)
        links = self.links + moved
        start = None if self.base is None else self._twisted(free[:, -TWIST:])
        no_signs = np.zeros(links.shape[:2], dtype=np.int_)
        _, poses = match_tables(links, no_signs, self.targets, self.length_scale, start=start)
        return misfits(poses, self.targets, self.length_scale)

    def _twisted(self, twist: Numbers) -> Matrices:
        assert self.base is not None
        about_x, about_y, about_z = np.moveaxis(SMALL * twist[:, :3], 1, 0)
        turn = rot_x(about_x) @ rot_y(about_y) @ rot_z(about_z)
        turn[..., :3, 3] = np.swapaxes(SMALL * self.length_scale * twist[:, 3:], 1, 2)
        return np.asarray(turn @ self.base)

    def _sizes(self) -> Numbers:
        # How far a shift by one unit moves the cell of each decimal.
        cells = self.values.reshape(-1, SAMPLES)
        moved = self.decimals.shifted(np.eye(self.decimals.count), cells) - cells
        lengths = np.tile(np.where(IS_ANGLE, 1.0, self.length_scale), len(self.values))
        largest: Numbers = np.abs(moved / lengths[:, None]).max(axis=(1, 2))
        return np.maximum(largest, LEAST_SIZE)

    def fit(self) -> tuple[Numbers, Numbers] | None:
        count, sets = self.decimals.count, self.links.shape[-1]
        sizes = np.concatenate([self._sizes(), np.full(self.free, SMALL)])
        steps = difference_steps(sizes)
        ways = np.concatenate([np.diag(steps), -np.diag(steps), np.zeros((1, len(steps)))])

        def split(unknowns: Numbers) -> tuple[Numbers, Numbers]:
            return unknowns[:count], unknowns[count:].reshape(self.free, sets)

        def linearised(unknowns: Numbers) -> tuple[Numbers, Numbers]:
            shifts, free = split(unknowns)
            found = self.misfits(ways[:, :count] + shifts, ways[:, count:, None] + free)
            rates = found[: len(steps)] - found[len(steps) : -1]
            rates /= 2 * steps[:, None, None]
            # Each of the other unknowns affects only its own set of links.
            own = np.einsum("fnl,lk->flnk", rates[count:], np.eye(sets))
            size = found[-1].size
            columns = [rates[:count].reshape(count, size), own.reshape(self.free * sets, size)]
            return found[-1].ravel(), np.concatenate(columns).T

        sizes = np.concatenate([sizes[:count], np.full(self.free * sets, SMALL)])
        found = fitted_unknowns(linearised, sizes, count, EXACT_VALUE)
        return None if found is None else split(found)


def with_true_numbers(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> tuple[Role, ...]:
    """Shift the decimals in the rows of ``roles`` so that the table describes the robot.

    A changed row keeps the written numbers in ``as_written``. Return ``roles`` itself if shifting
    is unnecessary or impossible.
    """
    if not _has_decimals(roles):
        return roles
    written, known = _with_known_angles(roles, grading)
    decimals = _decimals(written, grading, known)
    if decimals is None or _has_pose(roles, convention, grading):
        return roles
    for chain in _chains(written, roles, convention, freedom, decimals, grading):
        found = chain.fit()
        if found is not None:
            return _with_shifts(written, decimals, found[0])
    return roles


def with_rounded_cells(
    nearest: NearestTable, convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """Find the nearest valid table again, with exact numbers for rounded decimals.

    ``nearest`` was computed from the rounded decimals, so that even its correct cells differ
    slightly from the written ones.
    """
    roles = nearest.roles
    if nearest.cost < WRONG_CELL or not _has_decimals(roles):
        return nearest
    written, known = _with_known_angles(roles, grading)
    if _decimals(written, grading, known) is None:
        return nearest
    handed_in, scale = handed_in_values(written), grading.exercise.length_scale
    scales = np.where(IS_ANGLE, 1.0, scale)
    near = nearly_equal(handed_in, nearest.expected, scales, IS_ANGLE[:, None])
    unknown = [(i, column) for i, column in np.argwhere(~near).tolist()]
    decimals = _decimals(written, grading, [*known, *unknown])
    if decimals is None or len(unknown) > MOST_UNKNOWN:
        return nearest
    start = handed_in.copy()
    for cell in unknown:
        start[cell] = nearest.expected[cell]
    started = tuple(
        replace(role, row=replace(role.row, values=values)) if role.row else role
        for role, values in zip(written, start, strict=True)
    )
    for chain in _chains(started, started, convention, freedom, decimals, grading, unknown):
        found = chain.fit()
        if found is None:
            continue
        shifts, others = found
        expected = _shifted_values(decimals, shifts, handed_in)
        for i, cell in enumerate(unknown):
            unit = SMALL if IS_ANGLE[cell[1]] else SMALL * scale
            expected[cell] = start[cell] + np.resize(unit * others[i], SAMPLES)
        frames = nearest.frames
        if not freedom.base:
            frames = frames_from_reference(expected, started, convention, grading)
        return replace(nearest, expected=expected, frames=frames)
    return nearest


def _decimals(
    roles: tuple[Role, ...], grading: Grading, left_out: Sequence[CellIndex]
) -> SharedDecimals | None:
    # None if all decimals are exact, or a cell has no value.
    rows = [role.row for role in roles if role.row is not None]
    if len(rows) < len(roles):
        return None
    if not np.isfinite(handed_in_values(roles)).all():
        return None
    expressions = [each for row in rows for each in row.expressions]
    for i, column in left_out:
        expressions[len(COLUMNS) * i + column] = None
    decimals = SharedDecimals(expressions, grading.samples)
    # A number whose rounding is below the tolerance counts as exact.
    return decimals if decimals.units.max(initial=0.0) > EXACT_VALUE else None


def _has_decimals(roles: tuple[Role, ...]) -> bool:
    return any(role.row is not None and role.row.has_decimal for role in roles)


def _has_pose(roles: tuple[Role, ...], convention: Convention, grading: Grading) -> bool:
    # One sample is enough: then the table is most likely valid.
    reached = pose(handed_in_values(roles)[..., 0], convention)
    error = np.abs(reached - tool_pose(grading.exercise, grading.samples)[0])
    return bool(error.max() < SAME_POSE * max(1.0, grading.exercise.length_scale))


def _with_known_angles(
    roles: tuple[Role, ...], grading: Grading
) -> tuple[tuple[Role, ...], list[CellIndex]]:
    # A rounded angle is recognized if its exact value is known: 1.57 is π/2. The second result has
    # the cells of these angles.
    exercise, samples = grading.exercise, grading.samples
    written = _as_written(roles)
    known = [(i, column) for i, column in np.argwhere(known_angles(written, exercise, samples))]
    return (with_exact_angles(written, exercise, samples) if known else written), known


def _as_written(roles: tuple[Role, ...]) -> tuple[Role, ...]:
    return tuple(
        role
        if role.row is None or role.row.is_exact
        else replace(role, row=replace(role.row, values=role.row.handed_in, as_written=None))
        for role in roles
    )


def _chains(
    roles: tuple[Role, ...],
    based_on: tuple[Role, ...],
    convention: Convention,
    freedom: FrameFreedom,
    decimals: SharedDecimals,
    grading: Grading,
    unknown: Sequence[CellIndex] = (),
) -> list[_Chain]:
    # The roles ``based_on`` give the possible bases.
    exercise, samples = grading.exercise, grading.samples
    mechanism = mechanism_at(exercise, samples)
    rows = row_constants(roles, exercise.robot.joints, convention, samples)
    if any(row.wrong_regardless.any() for row in rows):
        return []
    links = np.array([row.written for row in rows])
    signs = np.array([row.joint_sign for row in rows])
    bases: list[Matrices | None] = [None]
    if freedom.base:
        near = row_constants(based_on, exercise.robot.joints, convention, samples)
        of_base = np.array([row.written for row in near])
        bases = list(possible_bases(of_base, signs, based_on, mechanism, freedom))
    has_letters = any(variable.joint is None for variable in exercise.variables)
    count = (HALF if unknown else LINKS) if has_letters else 1
    return [
        _Chain(
            links[..., :count],
            handed_in_values(roles),
            targets_of(roles, convention, mechanism, freedom),
            None if base is None else base[:count],
            unknown,
            decimals,
            convention,
            exercise.length_scale,
        )
        for base in bases
    ]


def _shifted_values(decimals: SharedDecimals, shifts: Numbers, values: Table) -> Table:
    moved: Table = decimals.shifted(shifts[None], values.reshape(-1, SAMPLES))[0]
    return moved.reshape(values.shape)


def _with_shifts(
    roles: tuple[Role, ...], decimals: SharedDecimals, shifts: Numbers
) -> tuple[Role, ...]:
    values = _shifted_values(decimals, shifts, handed_in_values(roles))
    return tuple(
        replace(role, row=replace(role.row, values=moved, as_written=role.row.handed_in))
        if role.row and np.abs(moved - role.row.values).max() > 0
        else role
        for role, moved in zip(roles, values, strict=True)
    )
