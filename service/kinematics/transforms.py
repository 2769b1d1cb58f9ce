"""Homogeneous transforms, for whole arrays at once.

Arguments are scalars or arrays that broadcast to one shape ``(...)``; results are ``(..., 4, 4)``.
Angles are in radians.
"""

# Lengths are in any one unit. Results are float64.

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Numbers of any shape; the last axis usually is the axis of samples.
Numbers = NDArray[np.float64]
Matrices = NDArray[np.float64]


def identity(shape: tuple[int, ...] = ()) -> Matrices:
    """Return the identity transform, repeated over the batch ``shape``: ``(*shape, 4, 4)``."""
    matrices = np.zeros((*shape, 4, 4))
    matrices[..., [0, 1, 2, 3], [0, 1, 2, 3]] = 1.0
    return matrices


def rot_x(angle: ArrayLike) -> Matrices:
    """Return the rotation by ``angle`` about x: R_1(φ), *Direct Kinematics (Part 2)*, §1.4."""
    return _rotation(angle, 1, 2)


def rot_y(angle: ArrayLike) -> Matrices:
    """Return the rotation by ``angle`` about y: R_2(φ), *Direct Kinematics (Part 2)*, §1.4."""
    return _rotation(angle, 2, 0)


def rot_z(angle: ArrayLike) -> Matrices:
    """Return the rotation by ``angle`` about z: R_3(φ), *Direct Kinematics (Part 2)*, §1.4."""
    return _rotation(angle, 0, 1)


def _rotation(angle: ArrayLike, first: int, second: int) -> Matrices:
    """Return the rotation by ``angle`` that turns axis ``first`` towards axis ``second``."""
    angle = np.asarray(angle, dtype=np.float64)
    cosine, sine = np.cos(angle), np.sin(angle)
    matrices = identity(angle.shape)
    matrices[..., first, first] = cosine
    matrices[..., second, second] = cosine
    matrices[..., first, second] = -sine
    matrices[..., second, first] = sine
    return matrices


def cross(one: Numbers, other: Numbers) -> Numbers:
    """Return the cross products of vectors ``(..., 3)``."""
    # Several times as fast as np.cross.
    a, b, c = (one[..., i] for i in range(3))
    d, e, f = (other[..., i] for i in range(3))
    return np.stack([b * f - c * e, c * d - a * f, a * e - b * d], axis=-1)


def inverse(transform: Matrices) -> Matrices:
    """Return the inverse [Rᵀ, −Rᵀp; 0 1] of rigid transforms ``(..., 4, 4)``.

    Source: *Direct Kinematics (Part 2)*, §1.6.
    """
    rotation_transposed = np.swapaxes(transform[..., :3, :3], -1, -2)
    inverted = np.zeros(transform.shape)
    inverted[..., 3, 3] = 1.0
    inverted[..., :3, :3] = rotation_transposed
    inverted[..., :3, 3] = -(rotation_transposed @ transform[..., :3, 3:])[..., 0]
    return inverted


def is_rigid(transform: Matrices, tolerance: float) -> NDArray[np.bool_]:
    """True for matrices ``(..., 4, 4)`` that are rigid transforms within the tolerance."""
    # The rotation must be right-handed, the last row (0, 0, 0, 1).
    rotation = transform[..., :3, :3]
    product = rotation @ np.swapaxes(rotation, -1, -2)
    error = np.abs(product - np.eye(3)).max(axis=(-1, -2))
    last_row = np.abs(transform[..., 3, :] - [0, 0, 0, 1]).max(axis=-1)
    right_handed = np.linalg.det(rotation) > 0
    return np.asarray((np.maximum(error, last_row) < tolerance) & right_handed)
