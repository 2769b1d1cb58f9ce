"""The single cells that a table would only need to have different.

The pose is the alternating product of Z = Rot_z(θ) Trans_z(d) and X = Trans_x(a) Rot_x(α). If one
factor alone is wrong, it has to be F = P⁻¹ T S⁻¹, where P is the product before it, S that behind
it and T the true pose. If F is a screw of that factor's axis, and one of its two numbers is the one
that was written, the other is the single cell that mends the table.

Shapes: L lanes (samples); a table is ``(rows, 4, L)`` in the column order a, α, d, θ, joint
variables and all; angles in radians.
"""

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import ALPHA, THETA, A, D, Table
from service.kinematics.dh import Convention, standard_link
from service.kinematics.transforms import Matrices, inverse

SAME = 1e-7

X_CELLS, Z_CELLS = (A, ALPHA), (D, THETA)


def single_mends(
    table: Table, convention: Convention, pose: Matrices, length_scale: float
) -> tuple[NDArray[np.bool_], Table]:
    """Which single cells mend the table, and what each would have to be.

    ``pose`` ``(L, 4, 4)`` is the true compound transform. Returns ``(rows, 4)`` and the values
    ``(rows, 4, L)``, meaningless where a cell does not mend. Whether the value is one that may
    stand there (constant, or the joint variable plus a constant) is not looked into.
    """
    rows = len(table)
    zero = np.zeros_like(table[:, 0])
    x = standard_link(table[:, A], table[:, ALPHA], zero, zero)
    z = standard_link(zero, zero, table[:, D], table[:, THETA])
    standard = convention is Convention.STANDARD
    factors = np.stack([z, x] if standard else [x, z], axis=1).reshape(2 * rows, *x.shape[1:])
    needed = _needed(factors, pose).reshape(rows, 2, *pose.shape)
    z_needed, x_needed = (needed[:, 0], needed[:, 1]) if standard else (needed[:, 1], needed[:, 0])
    mends = np.zeros((rows, 4), dtype=np.bool_)
    values = np.empty_like(table)
    for cells, found, axis in ((X_CELLS, x_needed, 0), (Z_CELLS, z_needed, 2)):
        length, angle, is_screw = _screw(found, axis, length_scale)
        values[:, cells[0]], values[:, cells[1]] = length, angle
        length_kept = _kept(table[:, cells[0]], length, length_scale, turns=False)
        angle_kept = _kept(table[:, cells[1]], angle, 1.0, turns=True)
        mends[:, cells[0]] = is_screw & angle_kept & ~length_kept
        mends[:, cells[1]] = is_screw & length_kept & ~angle_kept
    return mends, values


def _needed(factors: Matrices, pose: Matrices) -> Matrices:
    """What each factor would have to be for the product to be ``pose``."""
    before = np.empty_like(factors)
    behind = np.empty_like(factors)
    before[0] = behind[-1] = np.eye(4)
    for k in range(1, len(factors)):
        before[k] = before[k - 1] @ factors[k - 1]
        behind[-1 - k] = factors[-k] @ behind[-k]
    return inverse(before) @ pose @ inverse(behind)


def _screw(
    found: Matrices, axis: int, length_scale: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Shift along and turn about ``axis``, ``(rows, L)`` each, and which are such screws."""
    one, other = (axis + 1) % 3, (axis + 2) % 3
    angle = np.arctan2(found[..., other, one], found[..., one, one])
    along = np.abs(found[..., axis, axis] - 1)
    beside = np.abs(found[..., [one, other], 3]).max(axis=-1) / length_scale
    is_screw = np.maximum(along, beside).max(axis=-1) < SAME
    return found[..., axis, 3], angle, np.asarray(is_screw)


def _kept(
    written: NDArray[np.float64], needed: NDArray[np.float64], scale: float, *, turns: bool
) -> NDArray[np.bool_]:
    """Which numbers ``(rows, L)`` are as written."""
    error = written - needed
    if turns:
        error = error - 2 * np.pi * np.round(error / (2 * np.pi))
    return np.asarray(np.abs(error).max(axis=-1) < SAME * scale)
