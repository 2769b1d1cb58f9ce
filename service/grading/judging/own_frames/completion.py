"""Values for the cells that were not read, with which a table is valid.

Where such values exist, no cell that was read is wrong: what is missing may have been right. They
are looked for at one set of link lengths, where each unread cell is a constant, plus or minus its
joint's variable: the tool must be where the reference's is at all joint values. That is Newton's
method with damping (Levenberg and Marquardt), from many starts at once.

Shapes: S starts, L joint values, U unread cells and twists of a free base or tool.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from service.grading.judging.own_frames.few_cells import NearestTable
from service.grading.judging.own_frames.row_roles import (
    FrameFreedom,
    Role,
    handed_in_values,
    joint_cells,
)
from service.grading.part import Grading
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import HALF, SAMPLES, Samples
from service.kinematics.chain import A, D, Table, frames
from service.kinematics.dh import Convention
from service.kinematics.factors import CellIndex
from service.kinematics.frame_choice import WRONG_CELL
from service.kinematics.screws import adjoint, exponential
from service.kinematics.transforms import Matrices, Numbers, identity

STARTS, POSTURES, STEPS = 32, 6, 25
# After so many steps only the starts that came nearest go on.
SIFTED_AT, KEPT = 8, 12
# Poses are equal where they differ by less, in the exercise's typical length.
SAME = 1e-9
_DAMPING = 1e-3
_LEAST_DAMPING = 1e-12


@dataclass(frozen=True, slots=True)
class _Case:
    """A table with unread cells at one set of lengths, which are in the typical length.

    ``table`` is ``(rows, 4, L)`` with 0 in the ``unread`` cells, ``variables`` the joint variable
    that belongs in each of them ``(U, L)``, ``target`` the reference's tool frames ``(L, 4, 4)``.
    """

    table: Table
    unread: tuple[CellIndex, ...]
    variables: Numbers
    target: Matrices
    convention: Convention
    freedom: FrameFreedom


def completed(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable | None:
    """The handed-in table, if values in its unread cells make it valid; None where none are found.

    Nobody knows those values, so that 0 stands in the place of each, and the reference's frames in
    the place of the student's. Directions are taken as given.
    """
    if any(role.row is None for role in roles):
        return None
    case = _case(roles, convention, freedom, grading)
    if not case.unread or not _can_be_completed(case):
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
    unread = tuple((i, column) for i, column in np.argwhere(~finite).tolist())
    table[~finite] = 0.0
    table[:, [A, D]] /= exercise.length_scale
    joints = joint_cells(roles)
    variables = np.zeros((len(unread), POSTURES))
    for k, cell in enumerate(unread):
        if cell in joints:
            unit = 1.0 if IS_ANGLE[cell[1]] else exercise.length_scale
            variables[k] = samples.values[joints[cell].variable][:POSTURES] / unit
    target = exercise.robot.frame("tool", samples.values, SAMPLES)[:POSTURES].copy()
    target[:, :3, 3] /= exercise.length_scale
    return _Case(table, unread, variables, target, convention, freedom)


def _of_one_robot(samples: Samples, joints: Sequence[str]) -> Samples:
    """All joint values with the first link lengths."""
    return Samples(
        {
            name: values if name in joints else np.full_like(values, values[0])
            for name, values in samples.values.items()
        }
    )


def _values_at(role: Role, samples: Samples) -> Table:
    """A row's values at other samples, with what its rounded angles stand for."""
    assert role.row is not None
    made_exact = np.nan_to_num(role.row.values - role.row.handed_in)[:, :1]
    return np.asarray(role.row.values_at(samples) + made_exact)


def _can_be_completed(case: _Case) -> bool:
    """Whether one of the starts leads to a valid table."""
    rng = np.random.default_rng(HALF)
    count = len(case.unread)
    angle = np.array([bool(IS_ANGLE[column]) for _, column in case.unread])
    # Most angles are near a multiple of a quarter turn.
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
        change = _step(error, columns, damping)
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
    """The sign of the joint variable in each unread cell, ``(S, U)``: all combinations in turn."""
    signs = np.ones((STARTS, len(holds_variable)))
    places = [k for k, holds in enumerate(holds_variable) if holds]
    for bit, k in enumerate(places):
        signs[:, k] -= 2.0 * (np.arange(STARTS) >> bit & 1)
    return signs


def _linearised(
    case: _Case, constants: Numbers, signs: Numbers, base: Matrices, tool: Matrices
) -> tuple[Numbers, Numbers]:
    """How far the tool is from the reference's, ``(S, 12 L)``, and how that changes ``(…, U)``."""
    starts = len(constants)
    table = np.repeat(case.table[:, :, None], starts, axis=2)
    for k, cell in enumerate(case.unread):
        table[cell] = constants[:, k, None] + signs[:, k, None] * case.variables[k]
    reached = base @ frames(table, case.convention)
    pose = reached[-1] @ tool
    standard = case.convention is Convention.STANDARD
    screws = []
    for i, column in case.unread:
        about_z = column >= D
        frame = reached[i if about_z is standard else i + 1]
        axis = frame[..., :3, 2 if about_z else 0]
        if IS_ANGLE[column]:
            screws.append(np.concatenate([axis, np.cross(frame[..., :3, 3], axis)], axis=-1))
        else:
            screws.append(np.concatenate([np.zeros_like(axis), axis], axis=-1))
    columns = np.stack(screws, axis=-1)
    if case.freedom.base:
        everywhere = np.broadcast_to(np.eye(6), (*columns.shape[:-1], 6))
        columns = np.concatenate([columns, everywhere], axis=-1)
    if case.freedom.tool:
        columns = np.concatenate([columns, adjoint(pose)], axis=-1)
    # The change of each entry of the pose by a twist (ω; v): ω × column, and v + ω × p.
    motion = np.zeros((*columns.shape[:2], 3, 4, columns.shape[-1]))
    omega, v = columns[..., :3, :], columns[..., 3:, :]
    for j in range(4):
        at = pose[..., :3, j, None]
        motion[..., j, :] = np.cross(omega, at, axis=-2) + (v if j == 3 else 0.0)
    error = (case.target - pose)[..., :3, :]
    return error.reshape(starts, -1), motion.reshape(starts, -1, motion.shape[-1])


def _step(error: Numbers, columns: Numbers, damping: Numbers) -> Numbers:
    """The step ``(S, U)`` that lessens the error ``(S, E)``."""
    transposed = columns.swapaxes(-1, -2)
    square = transposed @ columns + damping[:, None, None] * np.eye(columns.shape[-1])
    return np.asarray(np.linalg.solve(square, transposed @ error[..., None])[..., 0])


def _moved(
    freedom: FrameFreedom, base: Matrices, tool: Matrices, twists: Numbers
) -> tuple[Matrices, Matrices]:
    """A free base and a free tool after their twists, ``(S, 1, 4, 4)`` each."""
    if freedom.base:
        base = exponential(twists[:, None, :6], 1.0) @ base
    if freedom.tool:
        tool = tool @ exponential(twists[:, None, -6:], 1.0)
    return base, tool
