"""Compare a student's chain of links with the reference solution, link by link.

The *relative pose* at a joint is the pose of the student's frame in the reference's frame there.

Shapes: L samples; a row is ``(4, L)`` with the columns a, α, d, θ.
"""

# A chain is T(q) = C_0 M_1(q_1) C_1 … M_n(q_n) C_n with constant links C_i. Two tables describe one
# mechanism if and only if constant transforms g_i exist with C_i(written) = g_i⁻¹ C_i(reference)
# g_{i+1}, where g_i keeps joint axis i (docs/frame-choice.md). So g_{i+1} follows from g_i and the
# written link, and must keep its axis. In the code g_i is the relative pose.
#
# A row stands for the product Z X that leads from one target to the next; angles in radians.

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.kinematics.dh import standard_link
from service.kinematics.frames.candidate_rows import TargetKind
from service.kinematics.tolerances import SAME_POSE
from service.kinematics.transforms import Matrices, Numbers, identity, inverse


@dataclass(frozen=True, slots=True)
class Target:
    """The axis or frame to which a row of the table leads."""

    kind: TargetKind
    # The reference's transform (L, 4, 4) from the previous joint's frame to the target's frame;
    # None for a fixed frame that the reference does not have.
    reference: Matrices | None

    @property
    def rebases(self) -> bool:
        """True if the transform to the next target starts from the frame at this target."""
        return self.reference is not None and self.kind is not TargetKind.FIXED


@dataclass(frozen=True, slots=True)
class RowConstants:
    """The constants in a row of the student's table, with facts about each cell."""

    # (4, L), NaN in a cell without a usable number.
    written: Numbers
    # (4,), as the next three: True for cells that can be right or wrong.
    is_gradable: NDArray[np.bool_]
    # True for cells that are wrong whatever frames are chosen.
    wrong_regardless: NDArray[np.bool_]
    # True for cells that the table does not have (they are 0).
    absent: NDArray[np.bool_]
    # The rounding error of each cell.
    slack: Numbers
    # The column of the row's joint variable, or None.
    variable: int | None
    # The sign of the joint variable: +1, -1, or 0 if unknown.
    joint_sign: int


@dataclass(frozen=True, slots=True)
class ChainMatch:
    """A correct table, and the poses of its frames in the frames of the reference solution."""

    # (rows, 4, L).
    rows: Numbers
    # The relative pose at each target, (rows, L, 4, 4).
    relative_poses: Matrices
    # The distance of the written table from this table.
    cost: float
    # The units of marks that the written table loses (frame_choice).
    lost: float = 0.0

    @property
    def joint_signs(self) -> list[int]:
        """The correct sign of the joint variable in each row."""
        signs: list[int] = joint_signs_of(self.relative_poses).tolist()
        return signs


def match_as_written(
    rows: Sequence[RowConstants],
    targets: Sequence[Target],
    length_scale: float,
    *,
    directions_given: bool = True,
    start: Matrices | None = None,
) -> ChainMatch | None:
    """Return the student's table if nothing in it is wrong, else None."""
    # directions_given is true if each joint's positive direction is given. start is the relative
    # pose of frame 0, None for the identity.
    if any(row.wrong_regardless.any() for row in rows):
        return None
    written = np.array([row.written for row in rows])
    signs = np.array([row.joint_sign if directions_given else 0 for row in rows])
    valid, poses = match_tables(written[None], signs[None], targets, length_scale, start=start)
    return ChainMatch(written, poses[:, 0], 0.0) if valid[0] else None


def match_tables(
    written: Numbers,
    joint_signs: NDArray[np.int_],
    targets: Sequence[Target],
    length_scale: float,
    tolerance: float = SAME_POSE,
    start: Matrices | None = None,
) -> tuple[NDArray[np.bool_], Matrices]:
    """Test which of many tables are correct.

    Return a mask ``(tables,)`` and the poses of the tables' frames in the reference solution's
    frames, ``(rows, tables, samples, 4, 4)``.
    """
    # written is (tables, rows, 4, L). joint_signs (tables, rows) are +1 or -1, or 0 where the sign
    # is unknown or the direction is free. start (L, 4, 4), or one for each table, is the relative
    # pose of frame 0, None for the identity. A table with NaN is not correct.
    count = written.shape[-1]
    links = standard_link(*np.moveaxis(written, 2, 0))
    pose = identity((len(written), count))
    if start is not None:
        pose[:] = start
    poses = np.empty((len(targets), *pose.shape))
    for i, target in enumerate(targets):
        pose = pose @ links[:, i]
        if target.reference is not None and target.rebases:
            pose = inverse(target.reference[:count]) @ pose
        poses[i] = pose
    valid = np.ones(len(written), dtype=np.bool_)
    for i, target in enumerate(targets):
        valid &= _error_at(poses[i], target.kind, length_scale) <= tolerance
        if i > 0:
            valid &= joint_signs[:, i] * joint_signs_of(poses[i - 1]) >= 0
    return valid, poses


def misfits(poses: Matrices, targets: Sequence[Target], length_scale: float) -> Numbers:
    """Return the n errors in the frames of each table, ``(tables, n, samples)``."""
    # poses (rows, tables, L, 4, 4) are the relative poses that match_tables returns. The directions
    # of the axes are ignored.
    unit = np.array([1.0, 1.0, 1.0, length_scale])
    missed: list[Numbers] = []
    for pose, target in zip(poses, targets, strict=True):
        if target.kind is TargetKind.TOOL:
            difference = (pose - np.eye(4))[..., :3, :] / unit
            missed.append(difference.reshape(*pose.shape[:2], -1))
        elif target.kind is TargetKind.REVOLUTE:
            off_axis = pose[..., :2, 2:] / unit[2:]
            missed.append(off_axis.reshape(*pose.shape[:2], -1))
        elif target.kind is TargetKind.PRISMATIC:
            missed.append(pose[..., :2, 2])
    return np.asarray(np.swapaxes(np.concatenate(missed, axis=-1), 1, 2))


def _error_at(pose: Matrices, kind: TargetKind, length_scale: float) -> Numbers:
    error: Numbers = np.abs(pose[:, :, :2, 2]).max(axis=(1, 2))
    if kind in (TargetKind.FIXED, TargetKind.OPEN):
        return np.where(np.isnan(error), np.nan, 0.0)
    if kind is not TargetKind.PRISMATIC:
        error = np.maximum(error, np.abs(pose[:, :, :2, 3]).max(axis=(1, 2)) / length_scale)
    if kind is TargetKind.TOOL:
        error = np.maximum(error, np.abs(pose - np.eye(4)).max(axis=(1, 2, 3)))
    return error


def joint_signs_of(pose: Matrices) -> NDArray[np.int_]:
    """Return +1 for each frame with the reference frame's z direction, −1 for the opposite one."""
    return np.where(pose[:, 0, 2, 2] > 0, 1, -1)
