"""What a cell owes to the joints, and what to the links."""

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.compare import Numbers, difference
from service.grading.samples import Samples

TOLERANCE = 1e-6


def halves(values: Numbers) -> tuple[Numbers, Numbers]:
    """Values ``(..., lanes)`` at the same links but other joint values: twice half the lanes."""
    half = values.shape[-1] // 2
    return values[..., :half], values[..., half:]


def changes(values: Numbers) -> Numbers:
    """By how much values ``(..., LANES)`` change when only the joints move: ``(..., SAMPLES)``."""
    before, after = halves(values)
    return after - before


def joint_counts(
    values: Numbers, joints: tuple[Joint, ...], samples: Samples, angle: NDArray[np.bool_]
) -> tuple[NDArray[np.int_], NDArray[np.bool_]]:
    """Whole numbers k with ``values = Σ k_j q_j + constant``, for each cell.

    ``values`` is ``(cells, LANES)``, ``angle`` ``(cells,)``. Returns the counts ``(cells, joints)``
    and which cells are of that form ``(cells,)``; an angle need be so only up to whole turns.

    One least-squares problem for all cells: the two halves of the lanes differ in the joints only.
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


def _solver(names: tuple[str, ...], samples: Samples) -> tuple[Numbers, Numbers]:
    """How the joints move between the halves, and the pseudo-inverse that tells their shares."""
    if names not in samples.solvers:
        moves = changes(np.array([samples.values[name] for name in names]))
        samples.solvers[names] = moves, np.asarray(np.linalg.pinv(moves), dtype=np.float64)
    return samples.solvers[names]
