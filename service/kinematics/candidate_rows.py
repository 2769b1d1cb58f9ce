"""The DH row that leads from a frame to the next axis: every one that there is.

A row moves by Rot_z(θ) Trans_z(d) Trans_x(a) Rot_x(α). Seen from the frame where it starts, the
next place is a transform ``target``; what of it must be met depends on the place: a revolute axis
is a line, a prismatic axis a direction, the tool a whole frame. Where the row is not determined by
that, the value that was written (``own``) is as good as the reference's, and both are offered.

Shapes: H hypotheses, K candidates for each, L samples. Rows are ``(..., 4, L)`` in the
column order a, α, d, θ; angles in radians. Parallelism is judged by the norm of the cross product,
which near 0 is the angle itself; a cosine near 1 would call axes parallel that are 4 mrad apart.
"""

from enum import Enum, IntEnum

import numpy as np
from numpy.typing import NDArray

from service.kinematics.transforms import Matrices, Numbers

PARALLEL = 1e-7
Z_SIGNS = np.array([1.0, 1.0, -1.0, -1.0])
X_SIGNS = np.array([1.0, -1.0, 1.0, -1.0])


class Position(IntEnum):
    """How one axis lies to another."""

    SKEW = 0
    PARALLEL = 1
    COINCIDENT = 2


class Place(Enum):
    """What a row leads to, and so how much of it is fixed."""

    REVOLUTE = "a line that the next z axis lies on"
    PRISMATIC = "a direction of the next z axis"
    FIXED = "a frame of a fixed row, which may be anywhere"
    TOOL = "the given end-effector frame"
    OPEN = "an end-effector frame of the student's choice"


def candidates(target: Matrices, own: Numbers, place: Place, length_scale: float) -> Numbers:
    """Every row that leads to ``place``: ``(H, K, 4, L)``.

    ``target`` is ``(H, L, 4, 4)``, of one class of position (skew, parallel, coincident) for all
    H; ``own`` is the row as written, ``(4, L)``, NaN where there is nothing that could be used.
    """
    if place is Place.TOOL:
        return to_frame(target)[:, None]
    if place is Place.OPEN:
        exact = to_frame(target)[:, None]
        return np.where(np.isnan(own), exact, own)
    position = Position(positions(target[:1], length_scale)[0])
    if place is Place.PRISMATIC:
        if position is Position.SKEW:
            return _moved(_skew(target, own), own)
        return _parallel_direction(target, own, position)
    rows = _BY_POSITION[position](target, own)
    if place is Place.FIXED and not np.isnan(own).any():
        anywhere = np.broadcast_to(own, (len(target), 1, *own.shape))
        rows = np.concatenate([anywhere, rows], axis=1)
    return rows


def positions(target: Matrices, length_scale: float) -> NDArray[np.int_]:
    """The Position of each target's z axis to the z axis here: ``(H,)`` from ``(H, L, 4, 4)``."""
    sine = np.hypot(target[..., 0, 2], target[..., 1, 2])
    offset = np.hypot(target[..., 0, 3], target[..., 1, 3])
    parallel = np.all(sine < PARALLEL, axis=-1)
    coincident = parallel & np.all(offset < PARALLEL * length_scale, axis=-1)
    found: NDArray[np.int_] = np.add(parallel, coincident, dtype=np.int_)
    return found


def to_frame(target: Matrices) -> Numbers:
    """The one row that can lead to a whole frame, ``(H, 4, L)`` from ``(H, L, 4, 4)``.

    It gets there only if x of the frame is at right angles to z here and meets it (the two DH
    conditions; Spong, Hutchinson, Vidyasagar, §3.2.1); ``misses`` tells.
    """
    theta = np.arctan2(target[..., 1, 0], target[..., 0, 0])
    alpha = np.arctan2(target[..., 2, 1], target[..., 2, 2])
    a = target[..., 0, 3] * np.cos(theta) + target[..., 1, 3] * np.sin(theta)
    return np.stack([a, alpha, target[..., 2, 3], theta], axis=1)


def misses(target: Matrices, length_scale: float) -> NDArray[np.bool_]:
    """Where no DH row leads to the frame ``target``: ``(H,)`` from ``(H, L, 4, 4)``."""
    x_along_z = np.abs(target[..., 2, 0]).max(axis=-1)
    norm = np.hypot(target[..., 0, 0], target[..., 1, 0])
    cross = target[..., 0, 0] * target[..., 1, 3] - target[..., 1, 0] * target[..., 0, 3]
    beside = np.abs(cross / np.maximum(norm, PARALLEL)).max(axis=-1)
    missed: NDArray[np.bool_] = (x_along_z > PARALLEL) | (beside > PARALLEL * length_scale)
    return missed


def _skew(target: Matrices, own: Numbers) -> Numbers:
    """Axes that are not parallel: x along the common normal, either way, and z either way."""
    ux, uy, uz = (target[..., i, 2] for i in range(3))
    px, py, pz = (target[..., i, 3] for i in range(3))
    sine = np.hypot(ux, uy)
    theta = np.arctan2(ux, -uy)
    a = (py * ux - px * uy) / sine
    x_sign, z_sign = _signs(target, theta, a, own)
    alpha = np.arctan2(x_sign * z_sign * sine[:, None], z_sign * uz[:, None])
    d = pz - uz * (px * ux + py * uy) / sine**2
    return _rows(x_sign * a[:, None], alpha, d[:, None], _turned(theta, x_sign))


def _signs(target: Matrices, theta: Numbers, a: Numbers, own: Numbers) -> tuple[Numbers, Numbers]:
    """The ways that x and z may point: two arrays that broadcast to ``(H, K, L)``.

    x lies along a normal at the angle ``theta`` ``(H, L)`` and goes the length ``a`` there, or
    points the other way. Where ``a`` is a difference of link lengths it changes its sign from
    sample to sample while x does not: so x is first taken the way of the reference's, and where the
    axis was moved, also the way of what was written.
    """
    x_axis = np.arctan2(target[..., 1, 0], target[..., 0, 0])
    along = np.cos(theta - x_axis)
    ways = [np.where(np.abs(np.abs(along) - 1).max(axis=-1, keepdims=True) < 1e-6, along, 1.0)]
    for written in (np.cos(theta - own[3]), a * own[0]):
        pattern = np.sign(written * ways[0])
        if not np.isnan(written).any() and np.ptp(pattern, axis=-1).any():
            ways.append(written)
    one_way = np.where(np.array(ways) < 0, -1.0, 1.0).swapaxes(0, 1)
    x_sign = np.concatenate([one_way, -one_way, one_way, -one_way], axis=1)
    z_sign = np.repeat([1.0, -1.0], 2 * len(ways))[:, None]
    return x_sign, z_sign


def _turned(theta: Numbers, x_sign: Numbers) -> Numbers:
    """The angle of x: ``theta`` ``(H, L)``, or half a turn on, for each sign ``(H, K, L)``."""
    return theta[:, None] + np.where(x_sign < 0, np.pi, 0.0)


def _rows(a: Numbers, alpha: Numbers, d: Numbers, theta: Numbers) -> Numbers:
    """Columns that broadcast to ``(H, K, L)`` as rows ``(H, K, 4, L)``."""
    return np.stack(np.broadcast_arrays(a, alpha, d, theta), axis=2)


def _twist(target: Matrices, z_sign: Numbers) -> Numbers:
    """α between parallel axes, 0 or π, for each sign: ``(H, K, L)``."""
    return np.where(target[:, None, :, 2, 2] * z_sign > 0, 0.0, np.pi)


def _or_reference(own: Numbers, reference: Numbers) -> Numbers:
    """What was written, or the reference's value where nothing was."""
    return np.where(np.isnan(own), reference, own)


def _parallel(target: Matrices, own: Numbers) -> Numbers:
    """Parallel axes: x points from one to the other, d is free (own d, or the reference's)."""
    px, py, pz = (target[..., i, 3] for i in range(3))
    theta, a = np.arctan2(py, px), np.hypot(px, py)
    x_sign, z_sign = _signs(target, theta, a, own)
    alpha = _twist(target, z_sign)
    return np.concatenate(
        [
            _rows(x_sign * a[:, None], alpha, d[:, None], _turned(theta, x_sign))
            for d in (_or_reference(own[2], pz), pz)
        ],
        axis=1,
    )


def _coincident(target: Matrices, own: Numbers) -> Numbers:
    """One line: θ and d are both free."""
    pz = target[..., 2, 3]
    x_axis = np.arctan2(target[..., 1, 0], target[..., 0, 0])
    alpha = _twist(target, Z_SIGNS[:, None])
    theta = _turned(x_axis, X_SIGNS[:, None] * np.ones_like(alpha))
    return np.concatenate(
        [
            _rows(np.zeros(1), alpha, d[:, None], angle)
            for d in (_or_reference(own[2], pz), pz)
            for angle in (_or_reference(own[3], theta), theta)
        ],
        axis=1,
    )


def _moved(rows: Numbers, own: Numbers) -> Numbers:
    """A direction only: the axis may be moved anywhere, so a and d are free, each by itself."""
    options = []
    for keep_a in (False, True):
        for keep_d in (False, True):
            moved = rows.copy()
            if not keep_a:
                moved[:, :, 0] = _or_reference(own[0], rows[:, :, 0])
            if not keep_d:
                moved[:, :, 2] = _or_reference(own[2], rows[:, :, 2])
            options.append(moved)
    return np.concatenate(options, axis=1)


def _parallel_direction(target: Matrices, own: Numbers, position: Position) -> Numbers:
    """A direction parallel to z here: a, d and θ are all free."""
    on_line = _BY_POSITION[position](target, own)
    free = np.empty((len(target), 2, 4, target.shape[1]))
    free[:] = _or_reference(own, on_line[:, :1])
    free[:, :, 1] = _twist(target, np.array([[1.0], [-1.0]]))
    with_own_length = on_line.copy()
    with_own_length[:, :, 0] = _or_reference(own[0], on_line[:, :, 0])
    with_reference_offset = free.copy()
    with_reference_offset[:, :, 2] = target[:, None, :, 2, 3]
    return np.concatenate([free, with_reference_offset, with_own_length, on_line], axis=1)


_BY_POSITION = {
    Position.SKEW: _skew,
    Position.PARALLEL: _parallel,
    Position.COINCIDENT: _coincident,
}
