"""Repair the pose of a table by changing one row.

Shapes: L samples; a pose is ``(L, 4, 4)``. Lengths are in a unit that suits the robot; angles are
in radians.
"""

# The pose is a product of link transforms. If one row alone is wrong, it has to be A = P⁻¹ T S⁻¹,
# where P is the product before it, S the product after it and T the true pose. If A is a link
# transform, its four numbers are the right row. The unit of length lets one tolerance serve lengths
# and angles.

from collections.abc import Set

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import ALPHA, THETA
from service.kinematics.dh_row import dh1_residual, dh2_residual, row
from service.kinematics.factors import CellIndex, Factors
from service.kinematics.repairs.cell_repairs import CellRepair
from service.kinematics.tolerances import SAME_POSE
from service.kinematics.transforms import Matrices, Numbers, inverse


def one_row_repairs(
    factors: Factors, pose: Matrices, wrong: Set[CellIndex] = frozenset()
) -> list[CellRepair]:
    """Return the repairs that change the cells of a single row."""
    # The cells of a repair always include the wrong cells of its row.
    needed = factors.inverse_before[:-1:2] @ pose @ factors.inverse_after[2::2]
    numbers = np.flatnonzero(_misfit(needed, factors).max(axis=-1) < SAME_POSE)
    values = row(needed[numbers], factors.convention)
    changed = _changed(values, factors.table[numbers])
    found = []
    for k, i in enumerate(numbers.tolist()):
        cells = [c for c in range(4) if changed[k, c] or (i, c) in wrong]
        if cells:
            found.append(CellRepair(tuple((i, column) for column in cells), values[k, cells]))
    return found


def repaired_row(factors: Factors, pose: Matrices, number: int) -> Numbers | None:
    """Return the row ``(4, samples)`` that corrects the pose, or None."""
    before, after = factors.before[2 * number], factors.after[2 * number + 2]
    needed = inverse(before) @ pose @ inverse(after)
    if _misfit(needed, factors).max() >= SAME_POSE:
        return None
    return row(needed, factors.convention)


def _misfit(needed: Matrices, factors: Factors) -> Numbers:
    # How far transforms (..., L, 4, 4) are from link transforms: (..., L).
    tilt = np.abs(dh1_residual(needed, factors.convention))
    return np.maximum(tilt, np.abs(dh2_residual(needed, factors.convention)))


def _changed(values: Numbers, written: Numbers) -> NDArray[np.bool_]:
    error = values - written
    angles = error[:, [ALPHA, THETA]]
    error[:, [ALPHA, THETA]] = angles - 2 * np.pi * np.round(angles / (2 * np.pi))
    return np.asarray(np.abs(error).max(axis=-1) >= SAME_POSE)
