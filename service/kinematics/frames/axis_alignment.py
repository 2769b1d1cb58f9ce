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

_EACH, _LAST = slice(None), slice(-1, None)


def align_axes(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """The transform ``(L, 4, 4)`` that takes the axes ``source`` as near as can be to ``target``.

    Both are ``(joints, L, 4, 4)``; of a ``sliding`` axis the direction alone counts.
    """
    aligned: Matrices = _aligned(source, target, sliding, _LAST)[0]
    return aligned


def align_first_axes(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """``align_axes`` for the first axis, the first two, the first three …: ``(n, L, 4, 4)``."""
    return _aligned(source, target, sliding, _EACH)


def _aligned(
    source: Matrices, target: Matrices, sliding: NDArray[np.bool_], numbers: slice
) -> Matrices:
    """``align_axes`` for several of the numbers of first axes, 1 to n: ``(m, L, 4, 4)``."""
    known = _known_to_first(len(source))[numbers]
    rotation = _bases(target, sliding, known) @ np.swapaxes(_bases(source, sliding, known), -1, -2)
    transform = identity(rotation.shape[:2])
    transform[..., :3, :3] = rotation
    transform[..., :3, 3] = _translations(source, target, rotation, sliding, numbers)
    return transform


def _bases(axes: Matrices, sliding: NDArray[np.bool_], known: NDArray[np.bool_]) -> Matrices:
    """Right-handed bases ``(m, L, 3, 3)`` that are fixed to the ``known`` axes: z along the first.

    x comes from the first axis that is not parallel to it, or else from the first parallel one that
    lies elsewhere.
    """
    z = axes[0, :, :3, 2]
    directions = axes[:, :, :3, 2]
    # Seen from a point of the first axis that turns.
    points = axes[..., :3, 3] - axes[np.argmin(sliding), :, :3, 3]
    points = np.where(sliding[:, None, None], 0.0, points)
    any_x = np.eye(3)[np.argmin(np.abs(z), axis=-1)]
    across = np.concatenate([directions, points, any_x[None]])
    across = across - (across * z).sum(axis=-1, keepdims=True) * z
    length = np.sqrt((across * across).sum(axis=-1))
    least = length.min(axis=-1)
    # Axes that should be parallel are nearly so where numbers were rounded: they come last.
    trust = 2 * (least > NOT_PARALLEL_BY_ROUNDING) + 2 * (least > CLEARLY_NOT_PARALLEL)
    trust[-1] = 1
    chosen = np.where(known, trust, -1).argmax(axis=1)
    x = across[chosen] / length[chosen][..., None]
    z = np.broadcast_to(z, x.shape)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def _known_to_first(joints: int) -> NDArray[np.bool_]:
    """Which directions, which points, and whether any x, are known of the first m axes."""
    first = np.tri(joints, dtype=np.bool_)
    return np.concatenate([first, first, np.ones((joints, 1), np.bool_)], axis=1)


def _translations(
    source: Matrices,
    target: Matrices,
    rotation: Matrices,
    sliding: NDArray[np.bool_],
    numbers: slice,
) -> Numbers:
    """The shifts ``(m, L, 3)`` after which the first turning axes meet, by least squares.

    With u along an axis and p from a point of the turned source to one of the target, it minimises
    Σ |(1 − u uᵀ)(p − shift)|².
    """
    u = target[..., :3, 2]
    projection = np.eye(3) - u[..., :, None] * u[..., None, :]
    projection[sliding] = 0.0
    turned = (rotation[:, None] @ source[..., :3, 3, None])[..., 0]
    p = target[..., :3, 3] - turned
    first = np.tri(len(source))[numbers, ..., None, None]
    left = projection.cumsum(axis=0)[numbers]
    right = ((projection @ p[..., None])[..., 0] * first).sum(axis=1)
    return np.asarray((np.linalg.pinv(left, hermitian=True) @ right[..., None])[..., 0])
