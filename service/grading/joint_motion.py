"""What a cell owes to the joints, and what to the links."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.catalogue import Joint
from service.grading.comparison import difference
from service.grading.samples import Samples
from service.kinematics.transforms import Numbers

TOLERANCE = 1e-6


def halves(values: Numbers) -> tuple[Numbers, Numbers]:
    """The two halves of values ``(..., samples)``: the same links at other joint values."""
    half = values.shape[-1] // 2
    return values[..., :half], values[..., half:]


def changes(values: Numbers) -> Numbers:
    """By how much values ``(..., SAMPLES)`` change when only the joints move: ``(..., HALF)``."""
    before, after = halves(values)
    return after - before


def moves_with(values: Numbers, motion: Numbers, angle: ArrayLike) -> NDArray[np.bool_]:
    """Which values ``(..., samples)`` change with the joints as ``motion`` does, or its opposite.

    ``motion`` is ``(..., samples / 2)``. Where a value is not a number it does not.
    """
    either_sense = np.array([motion, -motion])
    shape = (2, *[1] * (values.ndim - motion.ndim), *motion.shape)
    off = np.abs(difference(changes(values), either_sense.reshape(shape), angle)).max(axis=-1)
    return np.asarray(off.min(axis=0) < TOLERANCE)


def joint_counts(
    values: Numbers, joints: tuple[Joint, ...], samples: Samples, angle: NDArray[np.bool_]
) -> tuple[NDArray[np.int_], NDArray[np.bool_]]:
    """Whole numbers k with ``values = Σ k_j q_j + constant``, for each cell.

    ``values`` is ``(cells, SAMPLES)``, ``angle`` ``(cells,)``. Returns the counts ``(cells,
    joints)`` and which cells are of that form ``(cells,)``; an angle need be so only up to whole
    turns.

    One least-squares problem for all cells: the two halves of the samples differ in the joints
    only.
    """
    if not joints:
        return np.zeros((len(values), 0), np.int_), np.asarray(np.isfinite(values).all(axis=-1))
    moves, solver = _solver(tuple(joint.variable for joint in joints), samples)
    change = np.nan_to_num(changes(values), nan=np.inf, posinf=np.inf, neginf=np.inf)
    finite = np.asarray(np.isfinite(change).all(axis=-1))
    change = np.where(finite[:, None], change, 0.0)
    counts = np.round(change @ solver)
    counts = np.clip(counts, -99, 99)
    linear = finite & (np.abs(counts @ moves - change).max(axis=-1) < TOLERANCE)
    wound = np.flatnonzero(finite & ~linear & angle)
    if len(wound):
        either_way = np.array([moves, -moves])
        turned = difference(change[wound, None, None], either_way, angle=True)
        found = np.abs(turned).max(axis=-1) < TOLERANCE
        for k, way, joint in np.argwhere(found):
            counts[wound[k]], linear[wound[k]] = 0, True
            counts[wound[k], joint] = 1 - 2 * way
    return counts.astype(np.int_), linear


def coefficients(
    values: Numbers, joints: tuple[Joint, ...], samples: Samples, angle: NDArray[np.bool_]
) -> list[tuple[int, ...] | None]:
    """How often each joint variable is contained in each cell; None where not linearly."""
    counts, linear = joint_counts(values, joints, samples, angle)
    found = zip(counts.tolist(), linear.tolist(), strict=True)
    return [tuple(cell) if is_linear else None for cell, is_linear in found]


def _solver(names: tuple[str, ...], samples: Samples) -> tuple[Numbers, Numbers]:
    """How the joints move between the halves, and the pseudo-inverse that tells their shares."""

    def taken_apart() -> tuple[Numbers, Numbers]:
        moves = changes(np.array([samples.values[name] for name in names]))
        return moves, np.asarray(np.linalg.pinv(moves), dtype=np.float64)

    return samples.cached(names, taken_apart)
