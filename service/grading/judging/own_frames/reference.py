"""Convert the reference table for comparisons with a student's table."""

from dataclasses import dataclass
from itertools import accumulate
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise, ReferenceTable
from service.grading.judging.own_frames.row_roles import Role, joint_cells, variable_column
from service.grading.numerics.joint_motion import halves
from service.grading.numerics.samples import Samples
from service.kinematics.chain import Table, axis_frames, z_links
from service.kinematics.dh import Convention, standard_link
from service.kinematics.transforms import Matrices, inverse

_Cell = TypeVar("_Cell", bound=np.generic)


@dataclass(frozen=True, slots=True)
class Mechanism:
    """The constants of the reference robot, for several sets of link lengths."""

    # They are given at the first half of the samples (L of them). ``joints`` ``(n, L, 4, 4)`` are
    # the poses of the joint frames, each in the frame of the previous joint. ``fixed`` are the
    # frames of the fixed rows and ``tool`` is the end-effector frame, ``(L, 4, 4)`` each, in the
    # last joint's frame. ``offsets`` ``(n, L, 4, 4)`` is, for each joint, the transform Z that
    # consists of the constants in d and θ.
    joints: Matrices
    offsets: Matrices
    fixed: list[Matrices]
    tool: Matrices


def mechanism_at(exercise: Exercise, samples: Samples) -> Mechanism:
    """Return the constants of the robot in the exercise's reference table."""
    return samples.cached("mechanism", lambda: _mechanism(exercise, samples))


def _mechanism(exercise: Exercise, samples: Samples) -> Mechanism:
    robot = exercise.robot
    reference = robot.tables[robot.convention]
    values = reference_values(reference, samples).copy()
    for i, joint in enumerate(reference.joints):
        values[i, variable_column(joint)] -= samples.values[joint.variable]
    cells = regrouped(halves(values)[0], reference.convention)
    links = standard_link(*cells.swapaxes(0, 1))
    n = len(reference.joints)
    fixed = list(accumulate(links[n:], np.matmul))
    return Mechanism(links[:n], z_links(cells[1 : n + 1]), fixed[:-1], fixed[-1])


def reference_values(reference: ReferenceTable, samples: Samples) -> Table:
    """Return the reference table in numbers, ``(rows, 4, samples)``. Do not modify it."""
    return samples.cached(
        reference.convention, lambda: reference.values(samples.values, samples.count)
    )


def reference_frames(exercise: Exercise, convention: Convention, samples: Samples) -> Matrices:
    """Return the reference solution's frames on the joint axes and its tool frame.

    The shape is ``(joints + 1, samples, 4, 4)``.
    """
    # The frames are those of a table in ``convention``, even if the robot has no such table.

    def compute() -> Matrices:
        robot = exercise.robot
        table = robot.tables.get(convention) or robot.tables[robot.convention]
        reached = axis_frames(reference_values(table, samples), table.convention, convention)
        is_all = len(reached) == len(robot.joints) + 1
        return reached if is_all else reached[[*range(len(robot.joints)), -1]]

    return samples.cached(("frames", convention), compute)


def frames_on_axes(
    relative_poses: Matrices,
    links: Table,
    roles: tuple[Role, ...],
    convention: Convention,
    mechanism: Mechanism,
) -> Matrices:
    """Return the student's frames on the joint axes, relative to the reference frames.

    The shape is ``(joints, ..., 4, 4)``.
    """
    # ``relative_poses`` ``(rows + 1, ..., 4, 4)`` compare the frames of both tables before the
    # motion by d and θ. ``links`` ``(rows + 1, 4, ...)`` are the constants of the student's table,
    # as ``regrouped`` returns them.
    places = [i for i, _ in joint_cells(roles)]
    on_axes = relative_poses[places]
    if convention is Convention.STANDARD:
        return on_axes
    z = z_links(links[1:][places])
    between = (1,) * (z.ndim - mechanism.offsets.ndim)
    offsets = mechanism.offsets.reshape(len(places), *between, *mechanism.offsets.shape[1:])
    return np.asarray(inverse(offsets) @ on_axes @ z)


def tool_pose(exercise: Exercise, samples: Samples) -> Matrices:
    """Return the reference solution's end-effector frame in the base frame, ``(samples, 4, 4)``."""
    pose: Matrices = reference_frames(exercise, exercise.robot.convention, samples)[-1]
    return pose


def regrouped(cells: NDArray[_Cell], convention: Convention) -> NDArray[_Cell]:
    """Regroup the cells of a table into rows that each lead from one joint axis to the next.

    ``(rows, 4, ...)`` becomes ``(rows + 1, 4, ...)``.
    """
    # Each new row is a product Z X: first the motion along z by d and θ, then the motion along x by
    # a and α. Cells that the table lacks are 0.
    none = np.zeros_like(cells[:1])
    z = np.concatenate([none, cells])
    x = z if convention is Convention.STANDARD else np.concatenate([cells, none])
    return np.concatenate([x[:, :2], z[:, 2:]], axis=1)


def as_table(links: Table, convention: Convention) -> Table:
    """Convert regrouped rows ``(rows + 1, 4, ...)`` to a table: the inverse of ``regrouped``."""
    x = links[1:] if convention is Convention.STANDARD else links[:-1]
    return np.concatenate([x[:, :2], links[1:, 2:]], axis=1)
