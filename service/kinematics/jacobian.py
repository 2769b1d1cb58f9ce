"""The space Jacobian of a table, and its rank.

Each column of the Jacobian is the screw (ω; v) of a joint: six numbers in the base frame.

Source: Lynch and Park, *Modern Robotics*, §5.1.1, eq. 5.11.
"""

# ω = z and v = −ω × o for a revolute joint with the axis z through o; ω = 0 and v = z for a
# prismatic joint along z.
#
# Shapes: L samples and n joints; a table is (rows, 4, L), angles in radians. Lengths should be
# measured in a unit that suits the arm, so that they do not outweigh the angular parts.

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import Table, frames, joint_frames
from service.kinematics.dh import Convention
from service.kinematics.tolerances import SAME_SCREW, ZERO_SINGULAR_VALUE
from service.kinematics.transforms import cross

Screws = NDArray[np.float64]


def space_jacobian(
    table: Table, convention: Convention, rows: Sequence[int], prismatic: Sequence[bool]
) -> Screws:
    """Return the space Jacobian ``(L, 6, n)`` of n joints at L configurations of the table.

    ``rows`` has the row of each joint; ``prismatic`` is True for prismatic joints.
    """
    # The angular parts are above the linear parts, which have the table's unit of length.
    on_axes = joint_frames(frames(table, convention), convention)[list(rows)]
    axes, origins = on_axes[..., :3, 2], on_axes[..., :3, 3]
    slides = np.asarray(prismatic, dtype=np.bool_)[:, None, None]
    angular = np.where(slides, 0.0, axes)
    linear = np.where(slides, axes, cross(origins, axes))
    return np.moveaxis(np.concatenate([angular, linear], axis=-1), 0, -1)


def coincident(jacobian: Screws) -> NDArray[np.bool_]:
    """Return a mask ``(n, n)`` of the pairs of n joints that move the arm in the same way."""
    # They turn about the same line, or slide along the same direction, at every sample, possibly in
    # opposite senses. jacobian is (L, 6, n).
    one, other = jacobian[..., :, None], jacobian[..., None, :]
    error = np.minimum(np.abs(one - other).max(axis=(0, 1)), np.abs(one + other).max(axis=(0, 1)))
    return np.asarray((error < SAME_SCREW) & ~np.eye(len(error), dtype=np.bool_))


def rank(jacobian: Screws, zero: float = ZERO_SINGULAR_VALUE) -> int:
    """Return the median rank of L matrices with m rows and n columns, ``(L, m, n)``."""
    # It is the rank at a generic configuration: the median ignores single singular or badly rounded
    # configurations. A singular value counts as 0 up to zero times the largest singular value of
    # all samples (or times 1 if that is larger, because a joint's screw has an entry of size 1).
    singular = np.linalg.svd(jacobian, compute_uv=False)
    ranks = np.sort((singular > zero * singular.max(initial=1.0)).sum(axis=-1))
    return int(ranks[len(ranks) // 2])


def dependent(jacobian: Screws) -> NDArray[np.bool_]:
    """Return a mask of the columns that depend linearly on the remaining columns."""
    # They depend at each of the L samples. A column is independent of the others if and only if its
    # entry in every null vector is zero.
    _, singular, rows = np.linalg.svd(jacobian)
    n = jacobian.shape[-1]
    padded = np.zeros((len(jacobian), n))
    padded[:, : singular.shape[1]] = singular
    null = np.where((padded <= ZERO_SINGULAR_VALUE * singular[:, :1])[..., None], rows, 0.0)
    return np.asarray((np.abs(null).max(axis=1) > np.sqrt(ZERO_SINGULAR_VALUE)).all(axis=0))
