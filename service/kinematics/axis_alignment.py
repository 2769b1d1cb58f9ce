"""Where a free base frame has to lie so that the joint axes of one chain lie on those of another.

Each chain is given by its joint axes at the same joint values, ``(joints, L, 4, 4)``: frames whose
z axis is the joint's. The rotation follows from the directions of the axes, the translation then
from their positions. Where the axes leave something open (if all are parallel, for example), one of
the possible transforms is returned.
"""

import numpy as np
from numpy.typing import NDArray

from service.kinematics.tolerances import CLEARLY_NOT_PARALLEL, NOT_PARALLEL_BY_ROUNDING
from service.kinematics.transforms import Matrices, Numbers, identity


def align_axes(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """The transform ``(L, 4, 4)`` that takes the axes ``source`` as near as can be to ``target``.

    Both are ``(joints, L, 4, 4)``; of a ``sliding`` axis the direction alone counts.
    """
    rotation = _basis(target, sliding) @ np.swapaxes(_basis(source, sliding), -1, -2)
    transform = identity(source.shape[1:2])
    transform[:, :3, :3] = rotation
    transform[:, :3, 3] = _translation(source, target, rotation, sliding)
    return transform


def _basis(axes: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """A right-handed basis ``(L, 3, 3)`` that is fixed to the axes: z along the first of them.

    x comes from the first axis that is not parallel to it, or else from the first parallel one that
    lies elsewhere.
    """
    z = axes[0, :, :3, 2]
    directions = axes[:, :, :3, 2]
    # Seen from a point of the first axis that turns.
    points = axes[..., :3, 3] - axes[np.argmin(sliding), :, :3, 3]
    points = np.where(sliding[:, None, None], 0.0, points)
    ways = [*_across(directions, z), *_across(points, z)]
    lengths = [np.linalg.norm(across, axis=-1, keepdims=True) for across in ways]
    # Axes that should be parallel are nearly so where numbers were rounded.
    for least in (NOT_PARALLEL_BY_ROUNDING, CLEARLY_NOT_PARALLEL):
        for across, length in zip(ways, lengths, strict=True):
            if length.min() > least:
                return _from_x_and_z(across / length, z)
    x = _across(np.eye(3)[np.argmin(np.abs(z), axis=-1)], z)
    return _from_x_and_z(x / np.linalg.norm(x, axis=-1, keepdims=True), z)


def _across(vectors: Numbers, z: Numbers) -> Numbers:
    """The part of ``(..., L, 3)`` that is at right angles to ``z`` ``(L, 3)``."""
    return np.asarray(vectors - (vectors * z).sum(axis=-1, keepdims=True) * z)


def _from_x_and_z(x: Numbers, z: Numbers) -> Matrices:
    return np.stack([x, np.cross(z, x), z], axis=-1)


def _translation(
    source: Matrices, target: Matrices, rotation: Matrices, sliding: NDArray[np.bool_]
) -> Numbers:
    """The shift ``(L, 3)`` after which the turning axes meet, by least squares.

    With u along an axis and p from a point of the turned source to one of the target, it minimises
    Σ |(1 − u uᵀ)(p − shift)|².
    """
    u = target[~sliding, :, :3, 2]
    turned = (rotation @ source[~sliding, :, :3, 3, None])[..., 0]
    p = target[~sliding, :, :3, 3] - turned
    projection = np.eye(3) - u[..., :, None] * u[..., None, :]
    left = projection.sum(axis=0)
    right = (projection @ p[..., None])[..., 0].sum(axis=0)
    return np.asarray((np.linalg.pinv(left, hermitian=True) @ right[..., None])[..., 0])
