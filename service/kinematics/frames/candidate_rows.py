"""Find all DH rows that lead from a frame to the next joint axis, or to the tool.

Shapes: H hypotheses, K candidates for each, L samples; rows are ``(..., 4, L)`` with the columns a,
α, d, θ.
"""

# A row moves by Rot_z(θ) Trans_z(d) Trans_x(a) Rot_x(α). The next target is a transform relative to
# the frame before the row. Its kind decides what the row must match: the line of a revolute axis,
# the direction of a prismatic axis, or the whole frame of the tool. A value is called open if the
# geometry does not determine it. Then the written value is as good as the reference's value, so
# both are tried.
#
# The written row is (4, L), with NaN for cells without a usable number. Angles are in radians.

from enum import Enum, IntEnum

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import ALPHA, THETA, A, D
from service.kinematics.dh import Convention
from service.kinematics.dh_row import row
from service.kinematics.tolerances import ALONG_NORMAL, PARALLEL
from service.kinematics.transforms import Matrices, Numbers

_X_SIGNS = np.array([[1.0], [-1.0], [1.0], [-1.0]])
_Z_SIGNS = np.array([[1.0], [1.0], [-1.0], [-1.0]])


class AxisRelation(IntEnum):
    """The relative position of two axes."""

    SKEW = 0
    PARALLEL = 1
    COINCIDENT = 2


class TargetKind(Enum):
    """What a row of the table leads to, for example a revolute axis or the tool frame."""

    REVOLUTE = "a line that the next z axis lies on"
    PRISMATIC = "a direction of the next z axis"
    FIXED = "a frame of a fixed row, which may be anywhere"
    TOOL = "the given end-effector frame"
    OPEN = "an end-effector frame of the student's choice"


def candidate_rows(
    target: Matrices, written: Numbers, kind: TargetKind, length_scale: float
) -> Numbers:
    """Return all DH rows that lead to the next axes ``target``: ``(H, K, 4, L)``.

    There are K candidates for each of H hypotheses, at L samples. All axes in ``target`` must have
    the same ``AxisRelation`` to the previous z axis.
    """
    if kind is TargetKind.TOOL:
        return row(target, Convention.STANDARD)[:, None]
    if kind is TargetKind.OPEN:
        return written_or(written, row(target, Convention.STANDARD)[:, None])
    relation = AxisRelation(axis_relations(target[:1], length_scale)[0])
    if kind is TargetKind.PRISMATIC:
        if relation is AxisRelation.SKEW:
            return _with_open_lengths(_to_skew(target, written), written)
        return _to_parallel_direction(target, written, relation)
    rows = _TO_LINE[relation](target, written)
    if kind is TargetKind.FIXED and not np.isnan(written).any():
        as_written = np.broadcast_to(written, (len(target), 1, *written.shape))
        unmoved = as_written.copy()
        unmoved[:, :, D:] = 0.0
        rows = np.concatenate([as_written, unmoved, rows], axis=1)
    return rows


def axis_relations(target: Matrices, length_scale: float) -> NDArray[np.int_]:
    """Return the relation of the next z axis to the previous one, for each hypothesis."""
    sine = np.hypot(target[..., 0, 2], target[..., 1, 2])
    offset = np.hypot(target[..., 0, 3], target[..., 1, 3])
    parallel = np.all(sine < PARALLEL, axis=-1)
    coincident = parallel & np.all(offset < PARALLEL * length_scale, axis=-1)
    found: NDArray[np.int_] = np.add(parallel, coincident, dtype=np.int_)
    return found


def written_or(written: Numbers, other: Numbers) -> Numbers:
    """Return ``written`` with each NaN replaced by the value in ``other``."""
    return np.where(np.isnan(written), other, written)


def _to_skew(target: Matrices, written: Numbers) -> Numbers:
    # x is along the common normal. Both x and z may be reversed.
    ux, uy, uz = (target[..., i, 2] for i in range(3))
    px, py, pz = (target[..., i, 3] for i in range(3))
    sine = np.hypot(ux, uy)
    theta = np.arctan2(ux, -uy)
    a = (py * ux - px * uy) / sine
    x_sign, z_sign = _signs(target, theta, a, written)
    alpha = np.arctan2(x_sign * z_sign * sine[:, None], z_sign * uz[:, None])
    d = pz - uz * (px * ux + py * uy) / sine**2
    return _rows(x_sign * a[:, None], alpha, d[:, None], _half_turned(theta, x_sign))


def _to_parallel(target: Matrices, written: Numbers) -> Numbers:
    # x points from one axis to the other. d is open: the written and the reference's d are tried.
    px, py, pz = (target[..., i, 3] for i in range(3))
    theta, a = np.arctan2(py, px), np.hypot(px, py)
    x_sign, z_sign = _signs(target, theta, a, written)
    alpha = _parallel_twist(target, z_sign)
    return np.concatenate(
        [
            _rows(x_sign * a[:, None], alpha, d[:, None], _half_turned(theta, x_sign))
            for d in (written_or(written[D], pz), pz)
        ],
        axis=1,
    )


def _to_coincident(target: Matrices, written: Numbers) -> Numbers:
    # θ and d are open: the written and the reference's values are tried.
    pz = target[..., 2, 3]
    x_angle = np.arctan2(target[..., 1, 0], target[..., 0, 0])
    alpha = _parallel_twist(target, _Z_SIGNS)
    theta = _half_turned(x_angle, _X_SIGNS * np.ones_like(alpha))
    return np.concatenate(
        [
            _rows(np.zeros(1), alpha, d[:, None], angle)
            for d in (written_or(written[D], pz), pz)
            for angle in (written_or(written[THETA], theta), theta)
        ],
        axis=1,
    )


_TO_LINE = {
    AxisRelation.SKEW: _to_skew,
    AxisRelation.PARALLEL: _to_parallel,
    AxisRelation.COINCIDENT: _to_coincident,
}


def _with_open_lengths(rows: Numbers, written: Numbers) -> Numbers:
    # The rows turn z to a given direction that is not parallel to z. a and d are open, because only
    # the direction is given. Each of them is taken as written or from rows, in all combinations.
    options = []
    for columns in ((A, D), (A,), (D,), ()):
        moved = rows.copy()
        for column in columns:
            moved[:, :, column] = written_or(written[column], rows[:, :, column])
        options.append(moved)
    return np.concatenate(options, axis=1)


def _to_parallel_direction(target: Matrices, written: Numbers, relation: AxisRelation) -> Numbers:
    # a, d and θ are open, because only the direction is given.
    on_line = _TO_LINE[relation](target, written)
    as_written = np.empty((len(target), 2, 4, target.shape[1]))
    as_written[:] = written_or(written, on_line[:, :1])
    as_written[:, :, ALPHA] = _parallel_twist(target, np.array([[1.0], [-1.0]]))
    with_reference_offset = as_written.copy()
    with_reference_offset[:, :, D] = target[:, None, :, 2, 3]
    with_written_length = on_line.copy()
    with_written_length[:, :, A] = written_or(written[A], on_line[:, :, A])
    return np.concatenate([as_written, with_reference_offset, with_written_length, on_line], axis=1)


def _signs(
    target: Matrices, theta: Numbers, a: Numbers, written: Numbers
) -> tuple[Numbers, Numbers]:
    # The possible signs of x and z: two arrays that broadcast to (H, K, L). x is along a normal at
    # the angle theta (H, L), where the link length is a, or points the opposite way. If a is a
    # difference of lengths, its sign may change between samples, but the direction of x does not.
    # So the first x that is tried points the same way as the reference's x. If the axis was moved,
    # the directions of the written θ and a are tried, too.
    x_angle = np.arctan2(target[..., 1, 0], target[..., 0, 0])
    along = np.cos(theta - x_angle)
    is_along = np.abs(np.abs(along) - 1).max(axis=-1, keepdims=True) < ALONG_NORMAL
    ways = [np.where(is_along, along, 1.0)]
    for way in (np.cos(theta - written[THETA]), a * written[A]):
        pattern = np.sign(way * ways[0])
        if not np.isnan(way).any() and np.ptp(pattern, axis=-1).any():
            ways.append(way)
    one_way = np.where(np.array(ways) < 0, -1.0, 1.0).swapaxes(0, 1)
    x_sign = np.concatenate([one_way, -one_way, one_way, -one_way], axis=1)
    z_sign = np.repeat([1.0, -1.0], 2 * len(ways))[:, None]
    return x_sign, z_sign


def _half_turned(theta: Numbers, x_sign: Numbers) -> Numbers:
    # theta (H, L), plus π where the sign of x (H, K, L) is negative.
    return theta[:, None] + np.where(x_sign < 0, np.pi, 0.0)


def _parallel_twist(target: Matrices, z_sign: Numbers) -> Numbers:
    # α between parallel axes, 0 or π, for each sign (K, 1): (H, K, L).
    return np.where(target[:, None, :, 2, 2] * z_sign > 0, 0.0, np.pi)


def _rows(a: Numbers, alpha: Numbers, d: Numbers, theta: Numbers) -> Numbers:
    # (H, K, 4, L).
    hypotheses, candidates, samples = np.broadcast(a, alpha, d, theta).shape
    rows = np.empty((hypotheses, candidates, 4, samples))
    rows[:, :, A], rows[:, :, ALPHA], rows[:, :, D], rows[:, :, THETA] = a, alpha, d, theta
    return rows
