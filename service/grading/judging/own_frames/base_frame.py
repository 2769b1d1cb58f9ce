"""Where the student's frame 0 lies, if that is the student's own choice."""

from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.joint_motion import halves
from service.grading.judging.own_frames.constants import without_motion
from service.grading.judging.own_frames.frame_freedom import Freedom
from service.grading.judging.own_frames.reference import Mechanism, start_frames
from service.grading.judging.own_frames.row_roles import Role
from service.grading.samples import HALF
from service.kinematics.axis_alignment import carry
from service.kinematics.chain import pose
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, inverse


def own_bases(
    roles: tuple[Role, ...],
    joints: tuple[Joint, ...],
    convention: Convention,
    mechanism: Mechanism,
    freedom: Freedom,
) -> list[Matrices]:
    """Where a free frame 0 may lie in the reference's, ``(HALF, 4, 4)`` each.

    A given tool leaves one place. Otherwise the joint axes tell, each taken the way its variable
    says, or either way where the directions are free.
    """
    table = np.array([role.row.values for role in roles if role.row])
    if len(table) < len(roles) or np.isnan(table).any():
        return []
    if not freedom.tool:
        return [(mechanism.pose @ inverse(pose(table, convention)))[:HALF]]
    sliding = np.array([joint.prismatic for joint in joints])
    rows = [i for i, role in enumerate(roles) if role.joint is not None]
    at_rest, senses = (found[0] for found in without_motion(table[None], roles, mechanism.samples))
    if not freedom.directions:
        own = start_frames(halves(table)[0], convention)[rows]
        return [carry(_reversed(own, senses[rows]), mechanism.axes, sliding)]
    # A variable may run either way, so the axes are compared where all variables are 0. Only the
    # first axis and the next that is not parallel to it decide how the base is turned.
    own = start_frames(at_rest, convention)[rows]
    target = np.array(list(accumulate(mechanism.joints, np.matmul)))
    ways = [
        np.array([first, *[others] * (len(rows) - 1)]) for first in (1, -1) for others in (1, -1)
    ]
    return [carry(_reversed(own, way), target, sliding) for way in ways]


def _reversed(frames: Matrices, senses: NDArray[np.int_]) -> Matrices:
    """Joint frames with z the other way where a variable was written with a minus."""
    reversed_frames = frames.copy()
    reversed_frames[senses < 0, :, :3, :3] *= np.array([1.0, -1.0, -1.0])
    return reversed_frames
