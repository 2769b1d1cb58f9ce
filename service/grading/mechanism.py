"""The reference's constants, and the regrouping of rows that both conventions share."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

import numpy as np
from numpy.typing import NDArray

from service.catalogue import ReferenceTable
from service.grading.compare import Numbers
from service.grading.motion import halves
from service.grading.roles import variable_column
from service.grading.samples import Samples
from service.kinematics.chain import Table, pose
from service.kinematics.dh import Convention, standard_link
from service.kinematics.transforms import Matrices


@dataclass(frozen=True, slots=True)
class Mechanism:
    """The reference's constants: to each joint from the one before, and beyond the last joint.

    ``joints`` is ``(n, L, 4, 4)``; ``fixed`` are the frames of the fixed rows and ``tool`` that of
    the end effector, ``(L, 4, 4)``, seen from the last joint's frame; L is half the lanes.
    ``axes`` ``(n, L, 4, 4)`` are the joints' frames in the base frame, ``pose`` ``(lanes, 4, 4)``
    is the end effector's.
    """

    joints: Matrices
    fixed: list[Matrices]
    tool: Matrices
    axes: Matrices
    pose: Matrices
    samples: Samples
    length_scale: float


def mechanism_of(reference: ReferenceTable, samples: Samples, length_scale: float) -> Mechanism:
    """The mechanism that the reference's table describes, in any convention."""
    values = reference.values(samples.values, samples.lanes)
    end_effector = pose(values, reference.convention)
    axes = joint_frames(halves(values)[0], reference.convention)[: len(reference.joints)]
    for i, joint in enumerate(reference.joints):
        values[i, variable_column(joint)] -= samples.values[joint.variable]
    cells = regrouped(halves(values)[0], reference.convention, 0.0)
    links = standard_link(*cells.swapaxes(0, 1))
    n = len(reference.joints)
    fixed = list(accumulate(links[n:], np.matmul))
    return Mechanism(links[:n], fixed[:-1], fixed[-1], axes, end_effector, samples, length_scale)


def joint_frames(table: Table, convention: Convention) -> Matrices:
    """The frames ``(rows, L, 4, 4)`` that each row's Z starts from; its z axis is the joint's."""
    cells = regrouped(table, convention, 0.0)
    links = standard_link(*cells.swapaxes(0, 1))
    return np.array(list(accumulate(links[:-1], np.matmul)))


def regrouped(cells: NDArray[Any], convention: Convention, fill: object) -> NDArray[Any]:
    """Rows of a table as the products Z X that lead from each place to the next.

    ``(rows, 4, ...)`` becomes ``(rows + 1, 4, ...)``; where the table has no cell stands ``fill``.
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
