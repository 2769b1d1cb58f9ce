"""Find the poses that frame 0 may have if the student chose it."""

# Poses are compared with all joint variables 0. The joint screws and the pose there determine a
# chain (Lynch and Park, *Modern Robotics*, section 4.1).

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
    """Yield the poses that the student's frame 0 may have in the reference frame 0.

    A pose is ``(L, 4, 4)`` for L samples; None means the identity.
    """
    # ``links`` ``(rows + 1, 4, L)`` are the constants of the table, ``joint_signs`` ``(rows + 1,)``
    # the signs of its joint variables. A given tool frame allows one pose. Otherwise the joint axes
    # must lie on those of the reference.
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
        # The first axis and the next one that is not parallel to it fix the base's orientation.
        others = len(starts) - 1
        either = [np.array([z, *[x] * others]) for z, x in product((1, -1), repeat=2)]
    for signs in either:
        yield align_axes(directed(reached[starts], signs), axes, sliding)


def directed(frames: Matrices, signs: Integers) -> Matrices:
    """Return the frames, with the z axis reversed where the sign is −1."""
    directed = frames.copy()
    directed[signs < 0, :, :3, :3] *= np.array([1.0, -1.0, -1.0])
    return directed
