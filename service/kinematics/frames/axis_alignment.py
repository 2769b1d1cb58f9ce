"""Move a chain of links so that its joint axes coincide with those of another chain.

The joint axes are the z axes of frames ``(joints, L, 4, 4)``, where L is the number of samples.
"""

# The base frame of a chain is free. Both chains have the same joint values. The rotation follows
# from the directions of the axes, then the translation from their positions. If the axes do not
# determine the transform (all are parallel, for example), one of the possible transforms is
# returned.

import numpy as np
from numpy.typing import NDArray

from service.kinematics.tolerances import CLEARLY_NOT_PARALLEL, NOT_PARALLEL_BY_ROUNDING
from service.kinematics.transforms import Matrices, Numbers, identity

_EACH, _LAST = slice(None), slice(-1, None)


def align_axes(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """Return the transform ``(L, 4, 4)`` that best moves the axes ``source`` to ``target``.

    Both are ``(joints, L, 4, 4)``, where L is the number of samples. Only the direction of a
    ``sliding`` axis matters.
    """
    aligned: Matrices = _aligned(source, target, sliding, _LAST)[0]
    return aligned


def align_first_axes(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """Return the transforms that align the first 1, 2, … n axes: ``(n, samples, 4, 4)``."""
    return _aligned(source, target, sliding, _EACH)


def _aligned(
    source: Matrices, target: Matrices, sliding: NDArray[np.bool_], numbers: slice
) -> Matrices:
    # Aligns the first 1, 2, … n axes, or only a slice of these numbers: (m, L, 4, 4).
    known = _known_to_first(len(source))[numbers]
    rotation = _bases(target, sliding, known) @ np.swapaxes(_bases(source, sliding, known), -1, -2)
    transform = identity(rotation.shape[:2])
    transform[..., :3, :3] = rotation
    transform[..., :3, 3] = _translations(source, target, rotation, sliding, numbers)
    return transform


def _bases(axes: Matrices, sliding: NDArray[np.bool_], known: NDArray[np.bool_]) -> Matrices:
    # Right-handed bases (m, L, 3, 3) that are fixed to the known axes. z is along the first axis. x
    # points in the direction of the first axis that is not parallel to z, or else to the first
    # parallel axis at another place.
    z = axes[0, :, :3, 2]
    directions = axes[:, :, :3, 2]
    # Points are relative to the first revolute axis.
    points = axes[..., :3, 3] - axes[np.argmin(sliding), :, :3, 3]
    points = np.where(sliding[:, None, None], 0.0, points)
    any_x = np.eye(3)[np.argmin(np.abs(z), axis=-1)]
    across = np.concatenate([directions, points, any_x[None]])
    across = across - (across * z).sum(axis=-1, keepdims=True) * z
    length = np.sqrt((across * across).sum(axis=-1))
    least = length.min(axis=-1)
    # With rounded numbers, parallel axes may be slightly tilted, so nearly parallel ones come last.
    trust = 2 * (least > NOT_PARALLEL_BY_ROUNDING) + 2 * (least > CLEARLY_NOT_PARALLEL)
    trust[-1] = 1
    chosen = np.where(known, trust, -1).argmax(axis=1)
    x = across[chosen] / length[chosen][..., None]
    z = np.broadcast_to(z, x.shape)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def _known_to_first(joints: int) -> NDArray[np.bool_]:
    # A mask (n, 2 n + 1); row k is True for what the first k + 1 axes determine. The columns are
    # the n directions, the n points, and an arbitrary x, which is always True.
    first = np.tri(joints, dtype=np.bool_)
    return np.concatenate([first, first, np.ones((joints, 1), np.bool_)], axis=1)


def _translations(
    source: Matrices,
    target: Matrices,
    rotation: Matrices,
    sliding: NDArray[np.bool_],
    numbers: slice,
) -> Numbers:
    # The shifts (m, L, 3) that best move the revolute source axes to the target axes. With u along
    # an axis and p from a point of the rotated source axis to one of the target axis, the shift
    # minimises Σ |(1 − u uᵀ)(p − shift)|².
    u = target[..., :3, 2]
    projection = np.eye(3) - u[..., :, None] * u[..., None, :]
    projection[sliding] = 0.0
    turned = (rotation[:, None] @ source[..., :3, 3, None])[..., 0]
    p = target[..., :3, 3] - turned
    first = np.tri(len(source))[numbers, ..., None, None]
    left = projection.cumsum(axis=0)[numbers]
    right = ((projection @ p[..., None])[..., 0] * first).sum(axis=1)
    return np.asarray((np.linalg.pinv(left, hermitian=True) @ right[..., None])[..., 0])
