"""Search for values of a table's unreadable cells with which the table describes the robot.

If such values exist, no other cell is wrong. The method is Newton's with damping (Levenberg and
Marquardt), from many starts.
"""

# The value of an unread cell is a constant, or a constant plus or minus the joint variable that
# belongs in the cell. Shapes: S starts, L joint values, U unknowns (the unread cells, and the pose
# of a base or tool that the student chose).

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from service.grading.judging.own_frames.nearest.few_cells import NearestTable
from service.grading.judging.own_frames.row_roles import (
    FrameFreedom,
    Role,
    handed_in_values,
    joint_cells,
)
from service.grading.numerics.samples import HALF, SAMPLES, Samples
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE
from service.grading.work_budget import WorkBudget
from service.kinematics.chain import A, D, Table, frames
from service.kinematics.dh import Convention
from service.kinematics.frames.frame_choice import WRONG_CELL
from service.kinematics.screws import exponential
from service.kinematics.transforms import Matrices, Numbers, identity

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
    """A table with unread cells at one set of link lengths."""

    # The unit is the typical length. ``table`` is ``(rows, 4, L)`` with 0 in the ``unread`` cells
    # ``(U, 2)``. ``variables`` ``(U, L)`` is the joint variable that belongs in each unread cell.
    # ``target`` ``(L, 4, 4)`` are the tool frames of the reference.
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

    Return None if there are no such values. The result has 0 in the unreadable cells.
    """
    # The values are not unique.
    # The frames of the result are those of the reference. The directions of the joint axes count as
    # given.
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
    base, tool = _moved(
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
        moved_base, moved_tool = _moved(case.freedom, base, tool, change[:, count:])
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
    motion[..., 3:] = _cross(axis, pose[..., :3, 3] - point)
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


def _cross(one: Numbers, other: Numbers) -> Numbers:
    # Several times faster than numpy.cross.
    (a, b, c), (x, y, z) = np.moveaxis(one, -1, 0), np.moveaxis(other, -1, 0)
    return np.stack([b * z - c * y, c * x - a * z, a * y - b * x], axis=-1)


def _step(error: Numbers, columns: Numbers, damping: Numbers) -> Numbers:
    # ``error`` is ``(S, E)``, ``columns`` ``(S, U, E)``, the step ``(S, U)``.
    square = columns @ columns.swapaxes(-1, -2)
    square += damping[:, None, None] * np.eye(columns.shape[1])
    return np.asarray(np.linalg.solve(square, columns @ error[..., None])[..., 0])


def _promise(change: Numbers, error: Numbers, columns: Numbers) -> Numbers:
    # The share ``(S,)`` of the squared error that a step removes, to first order.
    undone = (change * (columns @ error[..., None])[..., 0]).sum(axis=-1)
    return np.asarray(undone / (error**2).sum(axis=-1))


def _moved(
    freedom: FrameFreedom, base: Matrices, tool: Matrices, twists: Numbers
) -> tuple[Matrices, Matrices]:
    # ``(S, 1, 4, 4)`` each.
    if freedom.base:
        base = exponential(twists[:, None, :6], 1.0) @ base
    if freedom.tool:
        tool = tool @ exponential(twists[:, None, -6:], 1.0)
    return base, tool
