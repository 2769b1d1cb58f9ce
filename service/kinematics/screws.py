"""Screw axes, their exponentials and the product of exponentials.

A screw axis is a six-vector (ω; v) with a unit vector ω along the axis and v = −ω × q + h ω, where
q is a point on the axis and h the pitch. For a prismatic joint, ω is 0 and v is a unit vector.

Source: Lynch and Park, *Modern Robotics*, chapters 3 and 4.
"""

# All functions are batched: screw axes are (..., 6). A prismatic joint has infinite pitch. Angles
# are in radians, lengths in any one unit. The source also uses the order (ω; v).

from functools import reduce

import numpy as np
from numpy.typing import ArrayLike

from service.kinematics.tolerances import NO_ROTATION
from service.kinematics.transforms import Matrices, Numbers, identity


def skew(vector: Numbers) -> Matrices:
    """Return the matrix ``(..., 3, 3)`` of the cross product with ``vector`` ``(..., 3)``.

    Source: *Modern Robotics*, eq. 3.30.
    """
    matrix = np.zeros((*vector.shape[:-1], 3, 3))
    x, y, z = np.moveaxis(vector, -1, 0)
    matrix[..., 0, 1], matrix[..., 0, 2], matrix[..., 1, 2] = -z, y, -x
    matrix[..., 1, 0], matrix[..., 2, 0], matrix[..., 2, 1] = z, -y, x
    return matrix


def exponential(screw: Numbers, amount: ArrayLike) -> Matrices:
    """Return the motion e^{[S]θ} ``(..., 4, 4)`` along ``screw`` ``(..., 6)`` by ``amount``.

    Source: *Modern Robotics*, proposition 3.25.

    >>> motion = exponential(np.array([0.0, 0, 1, 0, -2, 0]), np.pi)
    >>> np.round(motion @ [0, 0, 0, 1]) + 0.0
    array([4., 0., 0., 1.])
    """
    # The amount is (...). ω need not have unit length.
    amount = np.asarray(amount, dtype=np.float64)
    shape = np.broadcast_shapes(screw.shape[:-1], amount.shape)
    screw, amount = np.broadcast_to(screw, (*shape, 6)), np.broadcast_to(amount, shape)
    rate = np.linalg.norm(screw[..., :3], axis=-1)
    turns = rate > NO_ROTATION
    unit = screw / np.where(turns, rate, 1.0)[..., None]
    angle = np.where(turns, rate * amount, 0.0)[..., None, None]
    omega = skew(unit[..., :3])
    squared = omega @ omega
    motion = identity(shape)
    motion[..., :3, :3] += np.sin(angle) * omega + (1 - np.cos(angle)) * squared
    along = np.where(turns[..., None, None], angle, amount[..., None, None]) * np.eye(3)
    along = along + (1 - np.cos(angle)) * omega + (angle - np.sin(angle)) * squared
    motion[..., :3, 3] = (along @ unit[..., 3:, None])[..., 0]
    return motion


def turning_axis(displacement: Matrices, angle: float) -> Numbers:
    """Return the screw axis ``(..., 6)`` of a turn ``displacement`` by ``angle``.

    ``angle`` must not be a multiple of π. Source: *Modern Robotics*, algorithm in 3.3.3.2.
    """
    # The axis has no pitch. If the displacement (..., 4, 4) is not such a turn, the exponential of
    # the result is another motion.
    rotation = displacement[..., :3, :3]
    twice = rotation - np.swapaxes(rotation, -1, -2)
    omega = np.stack([twice[..., 2, 1], twice[..., 0, 2], twice[..., 1, 0]], axis=-1)
    omega = omega / (2 * np.sin(angle))
    squared = skew(omega) @ skew(omega)
    # The inverse of G(θ), eq. 3.92.
    inverse = np.eye(3) / angle - skew(omega) / 2
    inverse = inverse + (1 / angle - 1 / (2 * np.tan(angle / 2))) * squared
    v = (inverse @ displacement[..., :3, 3:])[..., 0]
    v = v - omega * (omega * v).sum(axis=-1, keepdims=True)
    return np.concatenate([omega, v], axis=-1)


def sliding_axis(displacement: Matrices, distance: float) -> Numbers:
    """Return the screw axis ``(..., 6)`` along which ``displacement`` slides by ``distance``."""
    v = displacement[..., :3, 3] / distance
    return np.concatenate([np.zeros_like(v), v], axis=-1)


def adjoint(transform: Matrices) -> Matrices:
    """Return the matrix ``(..., 6, 6)`` that converts screw axes from frame b to frame a.

    ``transform`` is the pose of b in a. Source: *Modern Robotics*, definition 3.20.
    """
    # [R, 0; [p] R, R].
    rotation = transform[..., :3, :3]
    matrix = np.zeros((*transform.shape[:-2], 6, 6))
    matrix[..., :3, :3] = matrix[..., 3:, 3:] = rotation
    matrix[..., 3:, :3] = skew(transform[..., :3, 3]) @ rotation
    return matrix


def moved(transform: Matrices, screws: Numbers) -> Numbers:
    """Convert screw axes ``(..., 6)`` from frame b to frame a.

    ``transform`` is the pose of b in a.
    """
    return np.asarray((adjoint(transform) @ screws[..., None])[..., 0])


def product_in_space(screws: Numbers, amounts: Numbers, home: Matrices) -> Matrices:
    """Return T(θ) = e^{[S_1]θ_1} … e^{[S_n]θ_n} M: ``(..., 4, 4)``.

    ``screws`` is ``(n, ..., 6)``, ``amounts`` ``(n, ...)``, ``home`` ``(..., 4, 4)``. Source:
    *Modern Robotics*, eq. 4.14.
    """
    return np.asarray(reduce(np.matmul, exponential(screws, amounts)) @ home)


def product_in_body(screws: Numbers, amounts: Numbers, home: Matrices) -> Matrices:
    """Return T(θ) = M e^{[B_1]θ_1} … e^{[B_n]θ_n}, with shapes as in ``product_in_space``.

    Source: *Modern Robotics*, eq. 4.16.
    """
    return np.asarray(home @ reduce(np.matmul, exponential(screws, amounts)))
