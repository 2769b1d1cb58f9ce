"""Find how values change when only the joints move."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.catalogue import Joint
from service.grading.numerics.comparison import difference
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import SAME_MOTION
from service.kinematics.transforms import Numbers


def halves(values: Numbers) -> tuple[Numbers, Numbers]:
    """Split values in two halves with the same link lengths, but different joint values."""
    half = values.shape[-1] // 2
    return values[..., :half], values[..., half:]


def changes(values: Numbers) -> Numbers:
    """Return the changes ``(..., HALF)`` of values ``(..., SAMPLES)`` when only the joints move."""
    before, after = halves(values)
    return after - before


def moves_with(values: Numbers, motion: Numbers, angle: ArrayLike) -> NDArray[np.bool_]:
    """Return a mask of the values that change by ``motion`` or −``motion`` if the joints move."""
    # Values are ``(..., samples)``, ``motion`` is ``(..., samples / 2)``. The mask is false for
    # NaN.
    either_sign = np.array([motion, -motion])
    shape = (2, *[1] * (values.ndim - motion.ndim), *motion.shape)
    error = np.abs(difference(changes(values), either_sign.reshape(shape), angle)).max(axis=-1)
    return np.asarray(error.min(axis=0) < SAME_MOTION)


def joint_counts(
    values: Numbers, joints: tuple[Joint, ...], samples: Samples, angle: NDArray[np.bool_]
) -> tuple[NDArray[np.int_], NDArray[np.bool_]]:
    """Return the factor of each joint variable in each cell, ``(cells, joints)``, and a mask.

    The mask marks the cells that are a constant plus whole multiples of the joint variables.
    """
    # Angles are compared up to whole turns. ``values`` is ``(cells, SAMPLES)``, ``angle`` and the
    # mask are ``(cells,)``.
    if not joints:
        return np.zeros((len(values), 0), np.int_), np.asarray(np.isfinite(values).all(axis=-1))

    names = tuple(joint.variable for joint in joints)

    def moves_and_inverse() -> tuple[Numbers, Numbers]:
        moves = changes(np.array([samples.values[name] for name in names]))
        return moves, np.asarray(np.linalg.pinv(moves), dtype=np.float64)

    moves, solver = samples.cached(names, moves_and_inverse)
    change = np.nan_to_num(changes(values), nan=np.inf, posinf=np.inf, neginf=np.inf)
    finite = np.asarray(np.isfinite(change).all(axis=-1))
    change = np.where(finite[:, None], change, 0.0)
    counts = np.round(change @ solver)
    counts = np.clip(counts, -99, 99)
    linear = finite & (np.abs(counts @ moves - change).max(axis=-1) < SAME_MOTION)
    # Whole turns spoil the least squares; for such cells, try each joint alone.
    turned = np.flatnonzero(finite & ~linear & angle)
    if len(turned):
        either_sign = np.array([moves, -moves])
        error = difference(change[turned, None, None], either_sign, angle=True)
        found = np.abs(error).max(axis=-1) < SAME_MOTION
        for k, negative, joint in np.argwhere(found):
            counts[turned[k]], linear[turned[k]] = 0, True
            counts[turned[k], joint] = 1 - 2 * negative
    return counts.astype(np.int_), linear


def coefficients(
    values: Numbers, joints: tuple[Joint, ...], samples: Samples, angle: NDArray[np.bool_]
) -> list[tuple[int, ...] | None]:
    """Return the factors of the joint variables in each cell; None for a nonlinear cell."""
    counts, linear = joint_counts(values, joints, samples, angle)
    found = zip(counts.tolist(), linear.tolist(), strict=True)
    return [tuple(cell) if is_linear else None for cell, is_linear in found]
