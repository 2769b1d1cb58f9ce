"""Where a free base frame has to lie so that one chain's joint axes come to lie on another's.

Each chain is given by its joint axes at the same joint values, ``(joints, L, 4, 4)``: frames whose
z axis is the joint's. Rigid transforms that carry all axes of one chain onto those of the other are
found from directions first and positions then; where the axes leave something open (all parallel,
say) any one of them will do.
"""

import numpy as np
from numpy.typing import NDArray

from service.kinematics.candidate_rows import PARALLEL
from service.kinematics.transforms import Matrices, Numbers, identity


def carry(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """The transform ``(L, 4, 4)`` that best carries the axes ``source`` onto the axes ``target``.

    Both are ``(joints, L, 4, 4)``; of a ``sliding`` axis the direction alone counts.
    """
    rotation = _basis(target, sliding) @ np.swapaxes(_basis(source, sliding), -1, -2)
    moved = identity(source.shape[1:2])
    moved[:, :3, :3] = rotation
    moved[:, :3, 3] = _translation(source, target, rotation, sliding)
    return moved


def _basis(axes: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """A right-handed basis ``(L, 3, 3)`` that is fixed to the axes: z along the first of them.

    x comes from the first axis that is not parallel to it, or from the first that lies beside it.
    """
    z = axes[0, :, :3, 2]
    across = axes[:, :, :3, 2]
    beside = np.where(sliding[:, None, None], 0.0, axes[..., :3, 3] - _first_point(axes, sliding))
    beside = beside - (beside * z).sum(axis=-1, keepdims=True) * z
    for offered in (*(across - (across * z).sum(axis=-1, keepdims=True) * z), *beside):
        length = np.linalg.norm(offered, axis=-1, keepdims=True)
        if length.min() > 100 * PARALLEL:
            x = offered / length
            return np.stack([x, np.cross(z, x), z], axis=-1)
    any_other = np.eye(3)[np.argmin(np.abs(z), axis=-1)]
    x = any_other - (any_other * z).sum(axis=-1, keepdims=True) * z
    x = x / np.linalg.norm(x, axis=-1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def _first_point(axes: Matrices, sliding: NDArray[np.bool_]) -> Numbers:
    turning = np.flatnonzero(~sliding)
    return np.asarray(axes[turning[0] if len(turning) else 0, :, :3, 3])


def _translation(
    source: Matrices, target: Matrices, rotation: Matrices, sliding: NDArray[np.bool_]
) -> Numbers:
    """The shift ``(L, 3)`` after which the turning axes meet, by least squares."""
    u = target[~sliding, :, :3, 2]
    turned = (rotation @ source[~sliding, :, :3, 3, None])[..., 0]
    apart = target[~sliding, :, :3, 3] - turned
    across = np.eye(3) - u[..., :, None] * u[..., None, :]
    normal = across.sum(axis=0)
    wanted = (across @ apart[..., None])[..., 0].sum(axis=0)
    return np.asarray((np.linalg.pinv(normal, hermitian=True) @ wanted[..., None])[..., 0])
