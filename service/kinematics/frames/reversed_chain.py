"""The inverse of a chain of links, which leads from the tool to the base.

Shapes: L samples; cells are ``(rows, 4, ...)`` with the columns a, α, d, θ.
"""

# The inverse of X_0 Z_1 X_1 … Z_m X_m is X_m⁻¹ Z_m⁻¹ … X_1⁻¹ Z_1⁻¹ X_0⁻¹, again an alternating
# product of screw motions about x and z. Its row j is the product Z X of Z_{m+1−j}⁻¹ and X_{m−j}⁻¹;
# the first row has no Z. Row j leads to the frame after Z_{m−j}, which is on the same axis as the
# frame before Z_{m−j}.

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import D
from service.kinematics.frames.candidate_rows import TargetKind
from service.kinematics.frames.chain_match import RowConstants, Target
from service.kinematics.transforms import Matrices, identity, inverse

_Cell = TypeVar("_Cell", bound=np.generic)


def reversed_cells(cells: NDArray[_Cell]) -> NDArray[_Cell]:
    """Return the cells of a table, rearranged for the inverse of the table's pose."""
    # The signs are unchanged; the function is its own inverse.
    x, z = cells[::-1, :D], np.roll(cells[::-1, D:], 1, axis=0)
    return np.concatenate([x, z], axis=1)


def reversed_rows(rows: Sequence[RowConstants]) -> list[RowConstants]:
    """Return the rows of the inverse chain."""
    of_joints = [rows[0], *rows[:0:-1]]
    cells = zip(
        -reversed_cells(np.array([row.written for row in rows])),
        reversed_cells(np.array([row.is_gradable for row in rows])),
        reversed_cells(np.array([row.wrong_regardless for row in rows])),
        reversed_cells(np.array([row.absent for row in rows])),
        reversed_cells(np.array([row.slack for row in rows])),
        strict=True,
    )
    return [
        RowConstants(*row, joint.variable, joint.joint_sign)
        for row, joint in zip(cells, of_joints, strict=True)
    ]


def reversed_targets(targets: Sequence[Target], offsets: Matrices) -> list[Target]:
    """Return what each row of the inverse chain leads to, from the tool to the base.

    ``offsets`` ``(n, L, 4, 4)`` are Rot_z(θ) Trans_z(d) of n joints at L samples, from the
    reference solution's constants.
    """
    here = identity((offsets.shape[1],))
    each_offset = iter(offsets)
    passed = []
    for target in targets:
        frame = None if target.reference is None else here @ target.reference
        if frame is not None and target.rebases:
            here = frame
        if target.kind in (TargetKind.REVOLUTE, TargetKind.PRISMATIC) and frame is not None:
            frame = frame @ next(each_offset)
        passed.append((target, frame))
    found = []
    for target, frame in passed[-2::-1]:
        found.append(replace(target, reference=None if frame is None else inverse(here) @ frame))
        if frame is not None and target.rebases:
            here = frame
    return [*found, Target(TargetKind.OPEN, inverse(here))]
