"""Check the two DH conditions of a transform, and find its DH row.

A transform has a DH row only if two axes are perpendicular (condition DH1) and meet (condition
DH2). The axes are x_1 and z_0 in the standard convention, x_0 and z_1 in the modified one.

Source: Spong, Hutchinson, Vidyasagar, *Robot Modeling and Control*, §3.2.1.
"""

# Also *Direct Kinematics (Part 2)*, §2.3. The inverse of a modified link transform is a standard
# one with all four numbers negated, so one formula serves both.

import numpy as np
from numpy.typing import NDArray

from service.kinematics.dh import Convention
from service.kinematics.tolerances import PARALLEL, X_ALONG_Z
from service.kinematics.transforms import Matrices, Numbers, inverse


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

    >>> from service.kinematics.dh import modified_link
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
