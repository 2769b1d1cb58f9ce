"""A serial chain as the alternating product X_0 Z_1 X_1 Z_2 X_2 … Z_m X_m.

Here Z_i = Rot_z(θ_i) Trans_z(d_i) and X_i = Trans_x(a_i) Rot_x(α_i). A table is an array ``(rows,
4, ...)`` with the columns a, α, d, θ; angles are in radians.
"""

# The two factors of each Z_i and X_i commute. The standard table groups the product as (Z_1
# X_1)(Z_2 X_2)…, the modified table as (X_0 Z_1)(X_1 Z_2)…. So converting a table means moving (a,
# α) by one row, without solving any equation. Numbers and formulas are regrouped the same way. The
# axes of an array after its rows and columns are the batch.

from collections.abc import Sequence
from functools import reduce
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from service.kinematics.dh import Convention, link_transforms, standard_link
from service.kinematics.transforms import Matrices, identity, inverse

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
