"""The reference as the grading of student's frames needs it, and the regrouping of rows."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise, ReferenceTable
from service.grading.joint_motion import halves
from service.grading.judging.own_frames.row_roles import variable_column
from service.grading.samples import Samples
from service.kinematics.chain import THETA, D, Table, frames, joint_frames, pose
from service.kinematics.dh import Convention, standard_link
from service.kinematics.factors import factors_of
from service.kinematics.transforms import Matrices, Numbers


@dataclass(frozen=True, slots=True)
class Mechanism:
    """The reference's constants, at the first half of the samples (L of them).

    ``joints`` ``(n, L, 4, 4)`` is the transform to each joint's frame from that of the joint
    before. ``fixed`` are the frames of the fixed rows and ``tool`` is the end effector's, ``(L, 4,
    4)`` each, seen from the last joint's frame. ``offsets`` ``(n, L, 4, 4)`` is the Z of the
    constants in each joint's d and θ. ``axes`` ``(n, L, 4, 4)`` are the joints' frames in the base
    frame; ``pose`` ``(samples, 4, 4)`` is the end effector's, at all samples.
    """

    joints: Matrices
    offsets: Matrices
    fixed: list[Matrices]
    tool: Matrices
    axes: Matrices
    pose: Matrices
    samples: Samples
    length_scale: float


def mechanism_at(exercise: Exercise, samples: Samples) -> Mechanism:
    """The mechanism that the exercise's reference describes, in any convention."""
    return samples.cached("mechanism", lambda: _mechanism(exercise, samples))


def _mechanism(exercise: Exercise, samples: Samples) -> Mechanism:
    robot = exercise.robot
    reference = robot.tables[robot.convention]
    moving = reference_values(reference, samples)
    axes = start_frames(halves(moving)[0], reference.convention)[: len(reference.joints)]
    values = moving.copy()
    for i, joint in enumerate(reference.joints):
        values[i, variable_column(joint)] -= samples.values[joint.variable]
    cells = regrouped(halves(values)[0], reference.convention, 0.0)
    links = standard_link(*cells.swapaxes(0, 1))
    n = len(reference.joints)
    zero = np.zeros_like(cells[1 : n + 1, D])
    fixed = list(accumulate(links[n:], np.matmul))
    return Mechanism(
        joints=links[:n],
        offsets=standard_link(zero, zero, cells[1 : n + 1, D], cells[1 : n + 1, THETA]),
        fixed=fixed[:-1],
        tool=fixed[-1],
        axes=axes,
        pose=pose(moving, reference.convention),
        samples=samples,
        length_scale=exercise.length_scale,
    )


def reference_values(reference: ReferenceTable, samples: Samples) -> Table:
    """The reference's table in numbers, ``(rows, 4, samples)``; it must not be written to."""
    return samples.cached(
        reference.convention, lambda: reference.values(samples.values, samples.count)
    )


def reference_frames(exercise: Exercise, convention: Convention, samples: Samples) -> Matrices:
    """The reference's frames on the joint axes and its tool's: ``(joints + 1, samples, 4, 4)``.

    They are the frames of a table of this convention, whether the robot has such a table or not.
    """
    return samples.cached(
        ("frames", convention), lambda: _frames_on_axes(exercise, convention, samples)
    )


def tool_pose(exercise: Exercise, samples: Samples) -> Matrices:
    """The reference's end-effector frame in the base frame, ``(samples, 4, 4)``."""
    pose: Matrices = reference_frames(exercise, exercise.robot.convention, samples)[-1]
    return pose


def _frames_on_axes(exercise: Exercise, convention: Convention, samples: Samples) -> Matrices:
    robot = exercise.robot
    table = robot.tables.get(convention)
    joints = range(len(robot.joints))
    if table is not None:
        reached = frames(reference_values(table, samples), convention)
        on_axes = joint_frames(reached, convention)[: len(joints)]
        return np.concatenate([on_axes, reached[-1:]])
    values = reference_values(robot.tables[robot.convention], samples)
    factors = factors_of(values, robot.convention)
    return np.concatenate([factors.joint_frames(list(joints), convention), factors.pose[None]])


def start_frames(table: Table, convention: Convention) -> Matrices:
    """The frames ``(rows, L, 4, 4)`` that each row's Z starts from; its z axis is the joint's."""
    cells = regrouped(table, convention, 0.0)
    links = standard_link(*cells.swapaxes(0, 1))
    return np.array(list(accumulate(links[:-1], np.matmul)))


def regrouped(cells: NDArray[Any], convention: Convention, fill: object) -> NDArray[Any]:
    """Rows of a table as the products Z X that lead from each target to the next.

    ``(rows, 4, ...)`` becomes ``(rows + 1, 4, ...)``, with ``fill`` where the table has no cell.
    """
    none = np.full((1, 2, *cells.shape[2:]), fill)
    x, z = cells[:, :2], cells[:, 2:]
    if convention is Convention.STANDARD:
        x, z = np.concatenate([none, x]), np.concatenate([none, z])
    else:
        x, z = np.concatenate([x, none]), np.concatenate([none, z])
    return np.concatenate([x, z], axis=1)


def as_table(rows: Sequence[Numbers], convention: Convention) -> Table:
    """The inverse of ``regrouped``."""
    links = np.array(rows)
    if convention is Convention.STANDARD:
        return links[1:]
    return np.concatenate([links[:-1, :2], links[1:, 2:]], axis=1)
