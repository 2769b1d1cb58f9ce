"""Joint screws of a table, which are the columns of its space Jacobian, and its rank.

A screw (ω; v) is a column of six numbers: ω = z and v = −ω × o for a joint that turns about the
axis z through o, ω = 0 and v = z for one that slides along z; both in the base frame.
Source: Lynch and Park, *Modern Robotics*, §5.1.1, eq. 5.11.

Shapes: L samples and n joints; a table is ``(rows, 4, L)``, angles in radians. Lengths should be
measured in a unit that suits the arm, or they outweigh the angular parts.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import Table, frames, joint_frames
from service.kinematics.dh import Convention
from service.kinematics.tolerances import SAME_SCREW, ZERO_SINGULAR_VALUE

Screws = NDArray[np.float64]


def space_jacobian(
    table: Table, convention: Convention, rows: Sequence[int], prismatic: Sequence[bool]
) -> Screws:
    """The space Jacobian ``(L, 6, n)`` at the configurations that the table is given in.

    ``rows`` says which row belongs to each joint, ``prismatic`` which joints slide. Angular over
    linear parts; the linear ones have the table's unit of length.
    """
    on_axes = joint_frames(frames(table, convention), convention)[list(rows)]
    axes, origins = on_axes[..., :3, 2], on_axes[..., :3, 3]
    slides = np.asarray(prismatic, dtype=np.bool_)[:, None, None]
    angular = np.where(slides, 0.0, axes)
    linear = np.where(slides, axes, np.cross(origins, axes))
    return np.moveaxis(np.concatenate([angular, linear], axis=-1), 0, -1)


def coincident(jacobian: Screws) -> NDArray[np.bool_]:
    """Which pairs of joints of ``(L, 6, n)`` are one joint twice, at every sample: ``(n, n)``.

    They turn about one line, or slide along one direction, in the same sense or the opposite.
    """
    one, other = jacobian[..., :, None], jacobian[..., None, :]
    error = np.minimum(np.abs(one - other).max(axis=(0, 1)), np.abs(one + other).max(axis=(0, 1)))
    return np.asarray((error < SAME_SCREW) & ~np.eye(len(error), dtype=np.bool_))


def rank(jacobian: Screws, zero: float = ZERO_SINGULAR_VALUE) -> int:
    """The rank of ``(L, m, n)`` at a generic configuration: the median of that of all samples.

    So neither a singular configuration nor a badly rounded one decides. A singular value counts as
    0 up to ``zero`` times the largest of all samples (or times 1, if all are smaller: a joint's
    screw has an entry of that size).
    """
    singular = np.linalg.svd(jacobian, compute_uv=False)
    ranks = np.sort((singular > zero * singular.max(initial=1.0)).sum(axis=-1))
    return int(ranks[len(ranks) // 2])


def dependent(jacobian: Screws) -> NDArray[np.bool_]:
    """Which columns of ``(L, 6, n)`` can be made up from the others at every sample, ``(n,)``.

    A column is independent of the others if and only if every null vector is zero there.
    """
    _, singular, rows = np.linalg.svd(jacobian)
    n = jacobian.shape[-1]
    padded = np.zeros((len(jacobian), n))
    padded[:, : singular.shape[1]] = singular
    null = np.where((padded <= ZERO_SINGULAR_VALUE * singular[:, :1])[..., None], rows, 0.0)
    return np.asarray((np.abs(null).max(axis=1) > np.sqrt(ZERO_SINGULAR_VALUE)).all(axis=0))
