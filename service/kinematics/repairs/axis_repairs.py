"""Repair the joint axes of a table by changing one cell.

Shapes: L samples, K factors (``factors``), n joints. Lengths are in a unit that suits the robot;
angles are in radians.
"""

# The base or the tool is free. If one cell is wrong, the factors before and after that cell's
# factor form two rigid bodies with fixed joint axes. The pose of the first body is known from a
# given frame 0, or from its own axes, which lie on the reference's axes. Then each axis of the
# second body must lie on the reference's axis, as seen from the frame before the wrong factor. So
# one axis that the cell moves determines the value of the cell. Other axes may contradict this
# value, so the caller must test it on the whole table.
#
# A turn t about the axis e takes a direction u to v if t = atan2(e·(u × v), u·v − (e·u)(e·v)). A
# shift along e brings a point p as near as possible to a line through r with the direction v if it
# is e·(1 − v vᵀ)(r − p) / (1 − (e·v)²).
#
# All joints are at 0. Seen from the other end, the table is the inverse product, so a given last
# frame can replace a given first one (reversed_factors).

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from service.kinematics.factors import SHIFT, TURN, Factors, Integers, screws
from service.kinematics.tolerances import CLEARLY_NOT_PARALLEL
from service.kinematics.transforms import Matrices, Numbers, inverse

# A factor, SHIFT or TURN, and its new value ``(L,)``.
FactorRepair = tuple[int, int, Numbers]


def reversed_factors(factors: Factors) -> Factors:
    """Return the factors of the inverse product."""
    return Factors(factors.convention, -factors.sizes[::-1], factors.axes[::-1])


def repairs_by_axes(
    factors: Factors,
    starts: Matrices,
    joints: Integers,
    axes: Matrices,
    sliding: NDArray[np.bool_],
) -> Iterator[FactorRepair]:
    """Yield values of single cells, each of which corrects the axis of a later joint.

    ``starts`` ``(K, L, 4, 4)`` are the frames before each of K factors, at L samples. ``axes``
    ``(n, L, 4, 4)`` are the correct axes of n joints.
    """
    # joints (n,) are the indices of the joints' factors. For a sliding axis, only the direction
    # counts. Axes may be reversed.
    behind = joints > np.arange(len(factors.axes))[:, None]
    wanted = inverse(starts)[:, None] @ axes
    seen = inverse(factors.before[1:])[:, None] @ factors.before[joints]
    for kind, solved in ((SHIFT, _shifts), (TURN, _turns)):
        sizes = factors.sizes.copy()
        sizes[:, kind] = 0.0
        right = screws(factors.axes, sizes[:, SHIFT], sizes[:, TURN])
        yield from solved(right[:, None] @ seen, wanted, factors.axes, behind, sliding)


def _shifts(
    seen: Matrices,
    wanted: Matrices,
    axes: Integers,
    behind: NDArray[np.bool_],
    sliding: NDArray[np.bool_],
) -> Iterator[FactorRepair]:
    # The shift of each factor that brings one later axis onto the wanted axis. This is the next
    # revolute axis that is not parallel to the factor's axis.
    k = np.arange(len(axes))
    v = wanted[..., :3, 2]
    cosine = v[k, :, :, axes]
    square = 1 - cosine * cosine
    moves = behind & ~sliding & (square.min(axis=-1) > CLEARLY_NOT_PARALLEL**2)
    way = wanted[..., :3, 3] - seen[..., :3, 3]
    along = way[k, :, :, axes] - cosine * (v * way).sum(axis=-1)
    for factor in np.flatnonzero(moves.any(axis=1)).tolist():
        joint = int(np.argmax(moves[factor]))
        yield factor, SHIFT, along[factor, joint] / square[factor, joint]


def _turns(
    seen: Matrices,
    wanted: Matrices,
    axes: Integers,
    behind: NDArray[np.bool_],
    sliding: NDArray[np.bool_],
) -> Iterator[FactorRepair]:
    # The turns of each factor that bring one later axis onto the wanted axis. This is the next axis
    # that is not parallel to the factor's axis. If all are parallel, it is the next revolute axis
    # that the turn moves.
    by_direction, turned = _turn(seen[..., :3, 2], wanted[..., :3, 2], axes)
    by_point, carried = _turn(seen[..., :3, 3], wanted[..., :3, 3], axes)
    turned &= behind
    carried &= behind & ~sliding
    for factor in np.flatnonzero(turned.any(axis=1)).tolist():
        joint = int(np.argmax(turned[factor]))
        yield factor, TURN, by_direction[factor, joint]
        yield factor, TURN, by_direction[factor, joint] + np.pi
    # All axes are parallel to the factor's, so that a turn changes only their positions.
    for factor in np.flatnonzero(carried.any(axis=1) & ~turned.any(axis=1)).tolist():
        yield factor, TURN, by_point[factor, int(np.argmax(carried[factor]))]


def _turn(u: Numbers, v: Numbers, axes: Integers) -> tuple[Numbers, NDArray[np.bool_]]:
    # The turns (K, n, L) from u to v, and a mask of the turns that exist.
    k = np.arange(len(axes))
    one, two = (axes + 1) % 3, (axes + 2) % 3
    u1, u2, v1, v2 = (w[k, :, :, across] for w in (u, v) for across in (one, two))
    size = np.minimum(np.hypot(u1, u2), np.hypot(v1, v2)).min(axis=-1)
    turn: Numbers = np.arctan2(u1 * v2 - u2 * v1, u1 * v1 + u2 * v2)
    return turn, np.asarray(size > CLEARLY_NOT_PARALLEL)
