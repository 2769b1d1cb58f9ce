"""Where the student's frame 0 lies, if that is the student's own choice."""

from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.joint_motion import halves
from service.grading.judging.own_frames.constants import without_variables
from service.grading.judging.own_frames.reference import Mechanism, start_frames
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role
from service.grading.samples import HALF
from service.kinematics.axis_alignment import align_axes
from service.kinematics.chain import pose
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, inverse


def possible_bases(
    roles: tuple[Role, ...],
    joints: tuple[Joint, ...],
    convention: Convention,
    mechanism: Mechanism,
    freedom: FrameFreedom,
) -> list[Matrices]:
    """Where a free frame 0 may lie in the reference's frame 0, ``(HALF, 4, 4)`` each.

    A given tool leaves one possibility. Otherwise the student's joint axes must lie on the
    reference's, each in the direction that the sign of its variable says, or in either direction
    where the directions are free.
    """
    table = np.array([role.row.values for role in roles if role.row])
    if len(table) < len(roles) or np.isnan(table).any():
        return []
    if not freedom.tool:
        return [(mechanism.pose @ inverse(pose(table, convention)))[:HALF]]
    sliding = np.array([joint.prismatic for joint in joints])
    rows = [i for i, role in enumerate(roles) if role.joint is not None]
    constants, signs = (x[0] for x in without_variables(table[None], roles, mechanism.samples))
    if not freedom.directions:
        student_axes = start_frames(halves(table)[0], convention)[rows]
        return [align_axes(_directed(student_axes, signs[rows]), mechanism.axes, sliding)]
    # A variable may have either sign, so the axes are compared where all variables are 0. Only the
    # first axis and the next that is not parallel to it decide how the base is turned.
    student_axes = start_frames(constants, convention)[rows]
    target = np.array(list(accumulate(mechanism.joints, np.matmul)))
    directions = [
        np.array([first, *[others] * (len(rows) - 1)]) for first in (1, -1) for others in (1, -1)
    ]
    return [align_axes(_directed(student_axes, signs), target, sliding) for signs in directions]


def _directed(frames: Matrices, signs: NDArray[np.int_]) -> Matrices:
    """The frames with z reversed where the sign is −1."""
    directed = frames.copy()
    directed[signs < 0, :, :3, :3] *= np.array([1.0, -1.0, -1.0])
    return directed
