"""Construct translations and screw axes as textbooks describe them."""

import numpy as np
from dh_grader.kinematics import Matrices, Numbers, identity
from numpy.typing import ArrayLike


def trans(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Matrices:
    """Return the translation by ``(x, y, z)``."""
    x, y, z = np.broadcast_arrays(x, y, z)
    matrices = identity(x.shape)
    matrices[..., 0, 3] = x
    matrices[..., 1, 3] = y
    matrices[..., 2, 3] = z
    return matrices


def screw_axis(direction: ArrayLike, point: ArrayLike, pitch: ArrayLike = 0.0) -> Numbers:
    """Return the screw axis along ``direction`` through ``point``."""
    # `pitch` is the advance per radian; it is infinite for a prismatic joint. Source: *Modern
    # Robotics*, definition 3.24.
    direction, point = np.broadcast_arrays(
        np.asarray(direction, dtype=np.float64), np.asarray(point, dtype=np.float64)
    )
    advance = np.asarray(pitch, dtype=np.float64)[..., None]
    slides = np.isinf(advance)
    moment = -np.cross(direction, point) + np.where(slides, 0.0, advance) * direction
    return np.concatenate(
        np.broadcast_arrays(np.where(slides, 0.0, direction), np.where(slides, direction, moment)),
        axis=-1,
    )
