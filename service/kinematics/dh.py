"""Link transforms of the two Denavit-Hartenberg conventions, for whole arrays at once.

Parameters are scalars or arrays that broadcast to one shape ``(...)``, with angles in radians.
Results are ``(..., 4, 4)``.
"""

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from service.kinematics.transforms import Matrices


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
