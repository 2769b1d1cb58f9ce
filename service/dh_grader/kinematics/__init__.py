"""Transforms, screws, rotations, DH links, chains, Jacobians; tolerances with their reasons.

All is numpy on batches. Nothing here knows exercises, formulas or students.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property, reduce
from typing import Final, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

# --- Every tolerance of the kinematics, each with its reason
#
# Poses are compared in a unit of length that suits the robot.
#
# A product of twenty matrices in double precision has an error of about 1e-15; different choices of
# a student differ by at least about 1e-4.


# Poses, relative poses and joint screws are equal if no entry differs by more.
SAME_POSE: Final = 1e-7
SAME_SCREW: Final = 1e-7

# Two axes are parallel if the norm of the cross product of their directions is smaller. Near 0 it
# equals the angle; with the cosine, axes 4 mrad apart would seem parallel. Parallel axes coincide
# if their distance is smaller.
PARALLEL: Final = 1e-7
# An axis that determines a basis must be clearly not parallel, because of a division by this sine.
CLEARLY_NOT_PARALLEL: Final = 100 * PARALLEL
# Parallel axes whose angles are rounded to three figures deviate from parallel by less than this.
NOT_PARALLEL_BY_ROUNDING: Final = 3e-2
# An x axis is along a common normal if the absolute value of the cosine differs less from 1.
ALONG_NORMAL: Final = 1e-6
# An x axis is along z if its projection on the plane perpendicular to z is shorter.
X_ALONG_Z: Final = 1e-9

# Frames of two hypotheses that would lead to the same table. It is wider than SAME_POSE: keeping a
# hypothesis twice wastes a place in the beam, and a dropped one has an equal one.
SAME_HYPOTHESIS: Final = 1e-6

# Smaller singular values, relative to the largest, are 0: it is far above rounding errors, and far
# below the values of any arm in a generic pose.
ZERO_SINGULAR_VALUE: Final = 1e-7

# Euler angles: the outer axes coincide if the sine (or cosine) of the middle angle is smaller.
OUTER_AXES_ALIGNED: Final = 1e-7

# A shorter ω is a rounding error, not an axis of rotation.
NO_ROTATION: Final = 1e-12

# The error of an exact table cell, as a multiple of its column's unit.
EXACT_CELL: Final = 1e-9
# The error of a rounded table cell, as a multiple of its column's unit.
ROUNDED_CELL: Final = 1e-3
# The largest numbers of the reference robot, as multiples of the column's unit: an angle is at most
# π, a length not much longer than the longest link.
LARGEST_ANGLE: Final = 4.0
LARGEST_LENGTH: Final = 1.5


# --- Homogeneous transforms, for whole arrays at once
#
# Arguments are scalars or arrays that broadcast to one shape ``(...)``; results are ``(..., 4,
# 4)``. Angles are in radians.
#
# Lengths are in any one unit. Results are float64.


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


# --- Screw axes, their exponentials and the product of exponentials
#
# A screw axis is a six-vector (ω; v) with a unit vector ω along the axis and v = −ω × q + h ω,
# where q is a point on the axis and h the pitch. For a prismatic joint, ω is 0 and v is a unit
# vector.
#
# Source: Lynch and Park, *Modern Robotics*, chapters 3 and 4.
#
# All functions are batched: screw axes are (..., 6). A prismatic joint has infinite pitch. Angles
# are in radians, lengths in any one unit. The source also uses the order (ω; v).


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


# --- Rotations about coordinate axes, and Euler angles
#
# A sequence names three axes, such as "ZYZ". Rotations are ``(..., 3, 3)``; angles are in radians.
#
# With moving axes, R = R_1(a_1) R_2(a_2) R_3(a_3). With fixed axes, R = R_3(a_3) R_2(a_2) R_1(a_1).
# Triples of angles are (..., 3), in the order of the sequence.


TAIT_BRYAN: Final = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
PROPER: Final = ("XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ")
SEQUENCES: Final = (*TAIT_BRYAN, *PROPER)

_TURNS = {"X": rot_x, "Y": rot_y, "Z": rot_z}


def about(axis: str, angle: ArrayLike) -> Matrices:
    """Return the fundamental rotation by ``angle`` about "X", "Y" or "Z": ``(..., 3, 3)``.

    Source: *Direct Kinematics (Part 2)*, §1.4.
    """
    return _TURNS[axis](angle)[..., :3, :3]


def composed(steps: Sequence[tuple[Matrices, bool]]) -> Matrices:
    """Return the composite of rotations ``(..., 3, 3)``, each with a flag: True for a fixed axis.

    Source: *Direct Kinematics (Part 2)*, §1.5.

    >>> quarter = np.pi / 2
    >>> fixed = composed([(about("Z", quarter), True), (about("X", quarter), True)])
    >>> np.round(fixed @ [1, 0, 0]) + 0.0
    array([0., 0., 1.])
    """
    product: Matrices = np.eye(3)
    for rotation, fixed in steps:
        product = rotation @ product if fixed else product @ rotation
    return product


def from_angles(sequence: str, angles: Numbers, *, fixed: bool = False) -> Matrices:
    """Return the rotation ``(..., 3, 3)`` that a triple of angles ``(..., 3)`` describes.

    Source: Craig, *Introduction to Robotics*, §2.8 and appendix B.

    >>> np.round(from_angles("ZYX", np.array([np.pi / 2, 0.0, np.pi / 2]))) + 0.0
    array([[0., 0., 1.],
           [1., 0., 0.],
           [0., 1., 0.]])
    """
    turns = [about(axis, angles[..., i]) for i, axis in enumerate(sequence)]
    if fixed:
        turns.reverse()
    return turns[0] @ turns[1] @ turns[2]


def to_angles(sequence: str, rotation: Matrices, *, fixed: bool = False) -> Numbers:
    """Return one of the two triples of angles ``(..., 3)`` that describe ``rotation``.

    Source: Shoemake, *Euler Angle Conversion*, Graphics Gems IV; for "ZYX" this is Craig, eq. 2.66.

    >>> to_angles("ZYX", from_angles("ZYX", np.array([0.3, -0.9, 1.2])))
    array([ 0.3, -0.9,  1.2])
    """
    # The middle angle is in [−π/2, π/2] for three different axes, and in [0, π] if the first axis
    # occurs twice. If only the sum or difference of the outer angles is determined, the last angle
    # is 0 (for fixed axes, the first angle is 0).
    if fixed:
        return to_angles(sequence[::-1], rotation)[..., ::-1]
    i, j = (ord(axis) - ord("X") for axis in sequence[:2])
    k = 3 - i - j
    even = 1.0 if (j - i) % 3 == 1 else -1.0
    if sequence[2] == sequence[0]:
        sine = np.hypot(rotation[..., i, j], rotation[..., i, k])
        middle = np.arctan2(sine, rotation[..., i, i])
        first = np.arctan2(rotation[..., j, i], -even * rotation[..., k, i])
        last = np.arctan2(rotation[..., i, j], even * rotation[..., i, k])
        outer = sine
    else:
        outer = np.hypot(rotation[..., i, i], rotation[..., i, j])
        middle = np.arctan2(even * rotation[..., i, k], outer)
        first = np.arctan2(-even * rotation[..., j, k], rotation[..., k, k])
        last = np.arctan2(-even * rotation[..., i, j], rotation[..., i, i])
    singular = outer < OUTER_AXES_ALIGNED
    first = np.where(singular, np.arctan2(even * rotation[..., k, j], rotation[..., j, j]), first)
    return np.stack([first, middle, np.where(singular, 0.0, last)], axis=-1)


def other_triple(sequence: str, angles: Numbers) -> Numbers:
    """Return the second triple of angles for the same rotation as ``angles``, ``(..., 3)``.

    Source: Craig, *Introduction to Robotics*, §2.8.
    """
    # The square root for the middle angle may have either sign. This holds for fixed axes, too.
    first, middle, last = np.moveaxis(angles, -1, 0)
    turned = -middle if sequence[2] == sequence[0] else np.pi - middle
    return np.stack([first + np.pi, turned, last + np.pi], axis=-1)


def is_singular(sequence: str, rotation: Matrices, *, fixed: bool = False) -> NDArray[np.bool_]:
    """True for rotations whose first and last angle are not unique: ``(...)``.

    Only the sum or difference of these angles is determined.
    """
    middle = to_angles(sequence, rotation, fixed=fixed)[..., 1]
    outer = np.sin(middle) if sequence[2] == sequence[0] else np.cos(middle)
    return np.asarray(np.abs(outer) < OUTER_AXES_ALIGNED)


def last_angle(sequence: str, first_two: Numbers, rotation: Matrices) -> Numbers:
    """Return the third angle ``(...)``, given the first two ``(..., 2)``, for moving axes."""
    # The first angle may be chosen freely only if the outer axes coincide.
    turned = about(sequence[0], first_two[..., 0]) @ about(sequence[1], first_two[..., 1])
    rest = np.swapaxes(turned, -1, -2) @ rotation
    axis = ord(sequence[2]) - ord("X")
    across, up = (axis + 1) % 3, (axis + 2) % 3
    return np.asarray(np.arctan2(rest[..., up, across], rest[..., across, across]))


# --- Link transforms of the two Denavit-Hartenberg conventions, for whole arrays at once
#
# Parameters are scalars or arrays that broadcast to one shape ``(...)``, with angles in radians.
# Results are ``(..., 4, 4)``.


class Convention(StrEnum):
    """The Denavit-Hartenberg convention of a table: standard (distal) or modified (proximal)."""

    STANDARD = "standard"
    MODIFIED = "modified"

    @property
    def other(self) -> "Convention":
        """The modified convention for the standard one, and the standard for the modified one."""
        return Convention.MODIFIED if self is Convention.STANDARD else Convention.STANDARD


def standard_link(a: ArrayLike, alpha: ArrayLike, d: ArrayLike, theta: ArrayLike) -> Matrices:
    """Return A_i = Rot_z(θ_i) Trans_z(d_i) Trans_x(a_i) Rot_x(α_i), the standard convention.

    Source: Spong, Hutchinson, Vidyasagar, *Robot Modeling and Control*, eq. 3.10.
    """
    cos_theta, sin_theta = np.cos(theta), np.sin(theta)
    cos_alpha, sin_alpha = np.cos(alpha), np.sin(alpha)
    link = np.zeros((*np.broadcast(a, alpha, d, theta).shape, 4, 4))
    link[..., 0, 0] = cos_theta
    link[..., 0, 1] = -sin_theta * cos_alpha
    link[..., 0, 2] = sin_theta * sin_alpha
    link[..., 0, 3] = a * cos_theta
    link[..., 1, 0] = sin_theta
    link[..., 1, 1] = cos_theta * cos_alpha
    link[..., 1, 2] = -cos_theta * sin_alpha
    link[..., 1, 3] = a * sin_theta
    link[..., 2, 1] = sin_alpha
    link[..., 2, 2] = cos_alpha
    link[..., 2, 3] = d
    link[..., 3, 3] = 1.0
    return link


def modified_link(a: ArrayLike, alpha: ArrayLike, d: ArrayLike, theta: ArrayLike) -> Matrices:
    """Return Rot_x(α_{i-1}) Trans_x(a_{i-1}) Rot_z(θ_i) Trans_z(d_i), the modified convention.

    Source: Craig, *Introduction to Robotics*, eq. 3.6.
    """
    # a and alpha are the entries of row i of the table, which have the index i-1.
    cos_theta, sin_theta = np.cos(theta), np.sin(theta)
    cos_alpha, sin_alpha = np.cos(alpha), np.sin(alpha)
    link = np.zeros((*np.broadcast(a, alpha, d, theta).shape, 4, 4))
    link[..., 0, 0] = cos_theta
    link[..., 0, 1] = -sin_theta
    link[..., 0, 3] = a
    link[..., 1, 0] = sin_theta * cos_alpha
    link[..., 1, 1] = cos_theta * cos_alpha
    link[..., 1, 2] = -sin_alpha
    link[..., 1, 3] = -sin_alpha * d
    link[..., 2, 0] = sin_theta * sin_alpha
    link[..., 2, 1] = cos_theta * sin_alpha
    link[..., 2, 2] = cos_alpha
    link[..., 2, 3] = cos_alpha * d
    link[..., 3, 3] = 1.0
    return link


def link_transforms(
    convention: Convention, a: ArrayLike, alpha: ArrayLike, d: ArrayLike, theta: ArrayLike
) -> Matrices:
    """Return the link transforms of whole tables at once, in the given convention."""
    link = standard_link if convention is Convention.STANDARD else modified_link
    return link(a, alpha, d, theta)


# --- Check the two DH conditions of a transform, and find its DH row
#
# A transform has a DH row only if two axes are perpendicular (condition DH1) and meet (condition
# DH2). The axes are x_1 and z_0 in the standard convention, x_0 and z_1 in the modified one.
#
# Source: Spong, Hutchinson, Vidyasagar, *Robot Modeling and Control*, §3.2.1.
#
# Also *Direct Kinematics (Part 2)*, §2.3. The inverse of a modified link transform is a standard
# one with all four numbers negated, so one formula serves both.


def _as_standard(transform: Matrices, convention: Convention) -> Matrices:
    return transform if convention is Convention.STANDARD else inverse(transform)


def dh1_residual(transform: Matrices, convention: Convention) -> Numbers:
    """Return the cosine of the angle between the two axes of condition DH1, ``(...)``.

    The axes are x_1 and z_0 (standard) or x_0 and z_1 (modified). DH1 holds if the result is 0.
    """
    return np.asarray(_as_standard(transform, convention)[..., 2, 0])


def dh2_residual(transform: Matrices, convention: Convention) -> Numbers:
    """Return the signed distance between the two axes of condition DH2, ``(...)``.

    The axes are x_1 and z_0 (standard) or x_0 and z_1 (modified). DH2 holds if the result is 0.
    """
    standard = _as_standard(transform, convention)
    x, y = standard[..., 0, 0], standard[..., 1, 0]
    px, py = standard[..., 0, 3], standard[..., 1, 3]
    norm = np.hypot(x, y)
    parallel = norm < X_ALONG_Z
    passing = (x * py - y * px) / np.where(parallel, 1.0, norm)
    return np.where(parallel, np.hypot(px, py), passing)


def row(transform: Matrices, convention: Convention) -> Numbers:
    """Return the row (a, α, d, θ) ``(..., 4, L)`` of transforms ``(..., L, 4, 4)`` at L samples.

    >>> row(modified_link(0.5, 0.2, 0.3, 0.7)[None], Convention.MODIFIED)[:, 0]
    array([0.5, 0.2, 0.3, 0.7])
    """
    standard = _as_standard(transform, convention)
    theta = np.arctan2(standard[..., 1, 0], standard[..., 0, 0])
    alpha = np.arctan2(standard[..., 2, 1], standard[..., 2, 2])
    a = standard[..., 0, 3] * np.cos(theta) + standard[..., 1, 3] * np.sin(theta)
    found = np.stack([a, alpha, standard[..., 2, 3], theta], axis=-2)
    return found if convention is Convention.STANDARD else -found


def is_unreachable(transform: Matrices, length_scale: float) -> NDArray[np.bool_]:
    """Return a mask ``(H,)``: which of H transforms ``(H, L, 4, 4)`` have no standard DH row.

    L is the number of samples.
    """
    tilt = np.abs(dh1_residual(transform, Convention.STANDARD)).max(axis=-1)
    distance = np.abs(dh2_residual(transform, Convention.STANDARD)).max(axis=-1)
    return np.asarray((tilt > PARALLEL) | (distance > PARALLEL * length_scale))


# --- A serial chain as the alternating product X_0 Z_1 X_1 Z_2 X_2 … Z_m X_m
#
# Here Z_i = Rot_z(θ_i) Trans_z(d_i) and X_i = Trans_x(a_i) Rot_x(α_i). A table is an array ``(rows,
# 4, ...)`` with the columns a, α, d, θ; angles are in radians.
#
# The two factors of each Z_i and X_i commute. The standard table groups the product as (Z_1
# X_1)(Z_2 X_2)…, the modified table as (X_0 Z_1)(X_1 Z_2)…. So converting a table means moving (a,
# α) by one row, without solving any equation. Numbers and formulas are regrouped the same way. The
# axes of an array after its rows and columns are the batch.


Table = NDArray[np.float64]
_Cell = TypeVar("_Cell")
Row = tuple[_Cell, _Cell, _Cell, _Cell]

COLUMNS = ("a", "alpha", "d", "theta")
A, ALPHA, D, THETA = range(4)
_IDENTITY = identity()


def modified_rows(standard: Sequence[Row[_Cell]], zero: _Cell) -> list[Row[_Cell]]:
    """Convert the rows of a standard table to rows of a modified table.

    A table of m rows becomes a table of m + 1 rows. The last row is the fixed row of the end
    effector.
    """
    # Regroups (Z_1 X_1)…(Z_m X_m) as (X_0 Z_1)…(X_{m-1} Z_m)(X_m), with X_0 the identity. The last
    # row has the label "e".
    none = (zero, zero, zero, zero)
    pairs = zip([none, *standard], [*standard, none], strict=True)
    return [(*before[:2], *row[2:]) for before, row in pairs]


def standard_rows(modified: Sequence[Row[_Cell]], zero: _Cell) -> list[Row[_Cell]]:
    """Convert the rows of a modified table to rows of a standard table.

    The first row must have a = 0 and α = 0.
    """
    # Regroups (X_0 Z_1)…(X_{m-1} Z_m) as (Z_1 X_1)…(Z_m). X_0, the identity, is dropped: a standard
    # table begins on the axis of joint 1.
    pairs = zip(modified, [*modified[1:], (zero, zero, zero, zero)], strict=True)
    return [(*after[:2], *row[2:]) for row, after in pairs]


def links(table: Table, convention: Convention) -> Matrices:
    """Return the link transform of each row: ``(rows, ..., 4, 4)`` from ``(rows, 4, ...)``."""
    return link_transforms(convention, table[:, A], table[:, ALPHA], table[:, D], table[:, THETA])


def compound(transforms: Matrices) -> Matrices:
    """Return the product A_1 A_2 … along the first axis of ``(rows, ..., 4, 4)``."""
    return reduce(np.matmul, transforms)


def frames(table: Table, convention: Convention) -> Matrices:
    """Return the base frame and the frame after each row of a table: ``(rows + 1, ..., 4, 4)``."""
    return products(links(table, convention))


def products(transforms: Matrices) -> Matrices:
    """Return the product of the first k of K transforms for k = 0..K: ``(K + 1, ...)``."""
    reached = np.empty((len(transforms) + 1, *transforms.shape[1:]))
    reached[0] = _IDENTITY
    reached[1:2] = transforms[:1]
    for i, transform in enumerate(transforms[1:], 1):
        np.matmul(reached[i], transform, out=reached[i + 1])
    return reached


def joint_frames(frames: Matrices, convention: Convention) -> Matrices:
    """Return, for each row, the frame whose z axis is the joint axis: ``(rows, ...)``.

    The joint axis of row i is z_{i-1} in a standard table and z_i in a modified one.
    """
    return frames[:-1] if convention is Convention.STANDARD else frames[1:]


def z_links(rows: Table) -> Matrices:
    """Return Rot_z(θ) Trans_z(d) of each row: ``(rows, ..., 4, 4)`` from ``(rows, 4, ...)``."""
    return standard_link(0.0, 0.0, rows[:, D], rows[:, THETA])


def axis_frames(table: Table, convention: Convention, wanted: Convention) -> Matrices:
    """Return the frames on the joint axes and the last frame: ``(rows + 1, ..., 4, 4)``.

    The frames are placed by the convention ``wanted``; the table may be in either convention.
    """
    # The frame of a joint is before Rot_z(θ) Trans_z(d) of its row in the standard convention,
    # after it in the modified one.
    reached = frames(table, convention)
    if wanted is convention is Convention.STANDARD:
        return reached
    on_axes = joint_frames(reached, convention)
    if wanted is not convention:
        z = z_links(table)
        on_axes = on_axes @ (z if wanted is Convention.MODIFIED else inverse(z))
    return np.concatenate([on_axes, reached[-1:]])


def pose(table: Table, convention: Convention) -> Matrices:
    """Return the compound transform of a table ``(rows, 4, ...)``: ``(..., 4, 4)``."""
    return compound(links(table, convention))


# --- The space Jacobian of a table, and its rank
#
# Each column of the Jacobian is the screw (ω; v) of a joint: six numbers in the base frame.
#
# Source: Lynch and Park, *Modern Robotics*, §5.1.1, eq. 5.11.
#
# ω = z and v = −ω × o for a revolute joint with the axis z through o; ω = 0 and v = z for a
# prismatic joint along z.
#
# Shapes: L samples and n joints; a table is (rows, 4, L), angles in radians. Lengths should be
# measured in a unit that suits the arm, so that they do not outweigh the angular parts.


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


# --- A table as a product of factors: alternating screw motions about x and z
#
# A screw motion is a shift along an axis and a turn about it. The factors are X = Trans_x(a)
# Rot_x(α) and Z = Rot_z(θ) Trans_z(d).
#
# Shapes: L samples, K factors; a table is ``(rows, 4, L)`` with the columns a, α, d, θ.
#
# Shift and turn of a factor commute. A standard table is Z_1 X_1 Z_2 X_2 …, a modified table X_0
# Z_1 X_1 Z_2 …. The cells include the joint variables; angles are in radians. Axes are numbered: 0
# is x, 2 is z.


Integers = NDArray[np.int_]

X, Z = 0, 2
# The two cells of a factor: the length of its shift, and the angle of its turn.
SHIFT, TURN = 0, 1

# A row and a column of a table.
CellIndex = tuple[int, int]


@dataclass(frozen=True)
class Factors:
    """The factors of a table: motions along and about x or z whose product is the table's pose."""

    convention: Convention
    # (K, 2, L): the SHIFT and the TURN of each factor.
    sizes: Numbers
    # (K,): 0 for x, 2 for z.
    axes: Integers

    @property
    def table(self) -> Table:
        """The table in numbers, ``(rows, 4, samples)``, with lengths in the unit of the factors."""
        sizes = self.sizes.reshape(-1, 2, 2, self.sizes.shape[-1])
        if self.convention is Convention.STANDARD:
            sizes = sizes[:, ::-1]
        return sizes.reshape(len(sizes), 4, -1)

    @cached_property
    def screws(self) -> Matrices:
        """The K factors as matrices at L samples, ``(K, L, 4, 4)``."""
        return screws(self.axes, self.sizes[:, SHIFT], self.sizes[:, TURN])

    @cached_property
    def before(self) -> Matrices:
        """The product of the first k factors for k = 0..K: ``(K + 1, L, 4, 4)`` at L samples."""
        return products(self.screws)

    @cached_property
    def after(self) -> Matrices:
        """The product of the factors k, k + 1, … for k = 0..K, ``(K + 1, samples, 4, 4)``."""
        reached = np.empty((len(self.axes) + 1, *self.screws.shape[1:]))
        reached[-1] = np.eye(4)
        for k in reversed(range(len(self.axes))):
            np.matmul(self.screws[k], reached[k + 1], out=reached[k])
        return reached

    @cached_property
    def inverse_before(self) -> Matrices:
        """The inverse of each matrix in ``before``."""
        return inverse(self.before)

    @cached_property
    def inverse_after(self) -> Matrices:
        """The inverse of each matrix in ``after``."""
        return inverse(self.after)

    def around(self, factor: int) -> tuple[Matrices, Matrices]:
        """Return the products of all factors before and after ``factor``.

        Each product is ``(L, 4, 4)``, with L samples.
        """
        before = reduce(np.matmul, self.screws[:factor], np.eye(4))
        return before, reduce(np.matmul, self.screws[factor + 1 :], np.eye(4))

    def cell(self, factor: int, kind: int) -> CellIndex:
        """Return the table cell of a factor's SHIFT or TURN."""
        return factor // 2, (A if self.axes[factor] == X else D) + kind

    def position(self, cell: CellIndex) -> tuple[int, int]:
        """Return the factor of a table cell, and whether the cell is its SHIFT or its TURN."""
        row, column = cell
        in_z = column >= D
        z_first = self.convention is Convention.STANDARD
        return 2 * row + (in_z != z_first), column - (D if in_z else A)


def factors_of(table: Table, convention: Convention, unit: float = 1.0) -> Factors:
    """Return the factors of a table ``(rows, 4, samples)``, with lengths measured in ``unit``."""
    sizes = table.reshape(len(table), 2, 2, -1)
    z_first = convention is Convention.STANDARD
    if z_first:
        sizes = sizes[:, ::-1]
    sizes = sizes / np.array([[unit], [1.0]])
    axes = np.tile([Z, X] if z_first else [X, Z], len(table))
    return Factors(convention, sizes.reshape(2 * len(table), 2, -1), axes)


def screws(axes: Integers, shifts: Numbers, turns: Numbers) -> Matrices:
    """Return K screw motions ``(K, L, 4, 4)`` about x, y or z axes, at L samples.

    ``axes`` is ``(K,)``; ``shifts`` and ``turns`` are ``(K, L)``.
    """
    k = np.arange(len(axes))
    one, other = (axes + 1) % 3, (axes + 2) % 3
    cosine, sine = np.cos(turns), np.sin(turns)
    matrices = np.zeros((*shifts.shape, 4, 4))
    matrices[k, :, axes, axes] = 1.0
    matrices[..., 3, 3] = 1.0
    matrices[k, :, one, one] = cosine
    matrices[k, :, other, other] = cosine
    matrices[k, :, one, other] = -sine
    matrices[k, :, other, one] = sine
    matrices[k, :, axes, 3] = shifts
    return matrices


def read_screws(transforms: Matrices, axes: Integers) -> tuple[Numbers, Numbers]:
    """Return each transform's shift and turn about its axis, and its deviation from a screw.

    For K transforms at L samples, ``(K, L, 4, 4)``, the results are ``(K, 2, L)`` and ``(K, L)``.
    """
    # The axes are (K,). The deviation is the tilt of the axis plus the distance of the origin from
    # it.
    k = np.arange(len(axes))
    one, other = (axes + 1) % 3, (axes + 2) % 3
    sizes = np.empty((len(axes), 2, transforms.shape[1]))
    sizes[:, SHIFT] = transforms[k, :, axes, 3]
    sizes[:, TURN] = np.arctan2(transforms[k, :, other, one], transforms[k, :, one, one])
    error = np.abs(transforms[k, :, one, 3]) + np.abs(transforms[k, :, other, 3])
    error += np.abs(transforms[k, :, one, axes]) + np.abs(transforms[k, :, other, axes])
    error += 1 - transforms[k, :, axes, axes]
    return sizes, error
