"""Rotations about coordinate axes, and Euler angles.

A sequence names three axes, such as "ZYZ". Rotations are ``(..., 3, 3)``; angles are in radians.
"""

# With moving axes, R = R_1(a_1) R_2(a_2) R_3(a_3). With fixed axes, R = R_3(a_3) R_2(a_2) R_1(a_1).
# Triples of angles are (..., 3), in the order of the sequence.

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.kinematics.tolerances import OUTER_AXES_ALIGNED
from service.kinematics.transforms import Matrices, Numbers, rot_x, rot_y, rot_z

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
    """True for rotations whose first and last angle are not unique."""
    # Only the sum or difference of these angles is determined.
    # The result is (...).
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
