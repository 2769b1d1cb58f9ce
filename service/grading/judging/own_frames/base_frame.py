"""Where a free frame 0 may lie, and whether a table is valid from there.

Everything is compared where all joint variables are 0: there it does not matter which way a joint
counts. That is enough, for the joint screws in the home configuration and the pose there say all of
a chain (Lynch and Park, *Modern Robotics*, section 4.1).
"""

from collections.abc import Iterator
from itertools import accumulate, product

import numpy as np

from service.grading.judging.own_frames.reference import Mechanism
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role
from service.kinematics.chain import Table, products
from service.kinematics.dh import standard_link
from service.kinematics.factors import Integers
from service.kinematics.frames.axis_alignment import align_axes
from service.kinematics.transforms import Matrices, inverse


def possible_bases(
    links: Table,
    joint_signs: Integers,
    roles: tuple[Role, ...],
    mechanism: Mechanism,
    freedom: FrameFreedom,
) -> Iterator[Matrices | None]:
    """Where frame 0 may lie in the reference's frame 0, ``(L, 4, 4)`` each; None for the same.

    ``links`` ``(rows + 1, 4, L)`` are the constants of a table, regrouped; ``joint_signs`` ``(rows
    + 1,)`` those of the variable of the joint that each of them starts from. A given tool leaves
    one possibility. Otherwise the joint axes must lie on the reference's, each in the direction
    that the sign of its variable says, or in either direction where the directions are free.
    """
    if not freedom.base:
        yield None
        return
    if np.isnan(links).any():
        return
    reached = products(standard_link(*links.swapaxes(0, 1)))
    axes = np.array(list(accumulate(mechanism.joints, np.matmul)))
    if not freedom.tool:
        yield axes[-1] @ mechanism.tool @ inverse(reached[-1])
        return
    starts = [i for i, role in enumerate(roles, start=1) if role.joint]
    sliding = np.array([role.joint.prismatic for role in roles if role.joint])
    either = [joint_signs[starts]]
    if freedom.directions:
        # The first axis and the next that is not parallel to it decide how the base is turned.
        others = len(starts) - 1
        either = [np.array([z, *[x] * others]) for z, x in product((1, -1), repeat=2)]
    for signs in either:
        yield align_axes(directed(reached[starts], signs), axes, sliding)


def directed(frames: Matrices, signs: Integers) -> Matrices:
    """The frames with z reversed where the sign is −1."""
    directed = frames.copy()
    directed[signs < 0, :, :3, :3] *= np.array([1.0, -1.0, -1.0])
    return directed
