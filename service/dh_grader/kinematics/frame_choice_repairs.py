"""Repair the pose or the axes of a table by other values of few cells, or of one row.

Lengths are in a unit that suits the robot, so that one tolerance serves lengths and angles; angles
are in radians. L is the number of samples. Whether a repaired table is right is for the caller.
"""

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dh_grader.kinematics import (
    ALPHA,
    CLEARLY_NOT_PARALLEL,
    SAME_POSE,
    SHIFT,
    THETA,
    TURN,
    CellIndex,
    Factors,
    Integers,
    Matrices,
    Numbers,
    dh1_residual,
    dh2_residual,
    inverse,
    read_screws,
    row,
    screws,
)

# --- Repair the pose of a table by changing one or two cells
#
# Shapes: C pairs of cells; a pose is ``(L, 4, 4)``.
#
# The pose is a product of ``Factors``, screws about x and z in turn. If one factor alone is
# wrong, it has to be F = P⁻¹ T S⁻¹, where P is the product before it, S the product after it and T
# the true pose. If F is a screw about that factor's axis, the shift and the turn of F are the right
# values of the two cells. If one of these values is as written, the other cell alone repairs the
# table.
#
# If one cell is wrong in each of two factors, A(x) M B(y) = N, where N = P⁻¹ T S⁻¹ as before and M
# is the product between the wrong cells, including the right cells of the two factors. A is a turn
# or a shift, and B is a turn or a shift. A turn leaves the points and the direction of its axis
# unchanged, a shift leaves all directions unchanged. So A(x) takes the points or directions that B
# leaves unchanged from M to N, which determines x. The remaining motion must then be a B(y).


@dataclass(frozen=True, slots=True)
class CellRepair:
    """Values ``(k, L)`` of k table cells at L samples that correct the pose of the table."""

    # The values need not be valid in their cells (a constant, or the joint variable plus a
    # constant).

    cells: tuple[CellIndex, ...]
    values: Numbers


def one_factor_repairs(factors: Factors, pose: Matrices) -> list[CellRepair]:
    """Return the repairs that change one or both cells of a single factor, single cells first."""
    needed = factors.inverse_before[:-1] @ pose @ factors.inverse_after[1:]
    sizes, error = read_screws(needed, factors.axes)
    changed = ~_equal(sizes, factors.sizes)
    repairs = []
    for k in np.flatnonzero((error.max(axis=-1) < SAME_POSE) & changed.any(axis=-1)).tolist():
        kinds = np.flatnonzero(changed[k]).tolist()
        repairs.append(CellRepair(tuple(factors.cell(k, kind) for kind in kinds), sizes[k, kinds]))
    return sorted(repairs, key=lambda repair: len(repair.cells))


def two_factor_repairs(factors: Factors, pose: Matrices) -> Iterator[CellRepair]:
    """Yield the repairs that change one cell in each of two factors."""
    # Most pairs of cells fail at the first sample; only the others are solved at all samples.
    a, b = np.triu_indices(len(factors.axes), 1)
    kinds = np.repeat([[SHIFT, SHIFT, TURN, TURN], [SHIFT, TURN, SHIFT, TURN]], len(a), axis=1)
    pairs = np.concatenate([np.tile([a, b], 4), kinds])
    _, possible = _solved(factors, pose, pairs, slice(0, 1))
    pairs = pairs[:, possible]
    if not pairs.size:
        return
    values, solved = _solved(factors, pose, pairs)
    for c in np.flatnonzero(solved).tolist():
        one, other, kind_one, kind_other = pairs[:, c].tolist()
        cells = factors.cell(one, kind_one), factors.cell(other, kind_other)
        yield CellRepair(cells, values[:, c])


def repaired_values(factors: Factors, pose: Matrices, cells: Sequence[CellIndex]) -> Numbers | None:
    """Return the values ``(k, L)`` of one or two cells that correct the pose, or None.

    This gives the values of a ``CellRepair`` at other samples than those where it was found.
    """
    positions = [factors.position(cell) for cell in cells]
    (a, kind_a), (b, kind_b) = min(positions), max(positions)
    if a != b:
        values, solved = _solved(factors, pose, np.array([[a], [b], [kind_a], [kind_b]]))
        values = values[:, 0] if positions[0] == (a, kind_a) else values[::-1, 0]
        return values if solved[0] else None
    before, after = factors.around(a)
    needed = inverse(before) @ pose @ inverse(after)
    sizes, error = read_screws(needed[None], factors.axes[a : a + 1])
    if error.max() >= SAME_POSE:
        return None
    return sizes[0, [kind for _, kind in positions]]


def _equal(sizes: Numbers, written: Numbers) -> NDArray[np.bool_]:
    error = sizes - written
    error[:, TURN] -= 2 * np.pi * np.round(error[:, TURN] / (2 * np.pi))
    return np.asarray(np.abs(error).max(axis=-1) < SAME_POSE)


def _solved(
    factors: Factors, pose: Matrices, pairs: Integers, samples: slice = slice(None)
) -> tuple[Numbers, NDArray[np.bool_]]:
    # Solves A(x) M B(y) = N for C pairs of wrong cells: returns x and y, (2, C, L), and a mask (C,)
    # of the pairs that are solved at all L samples. pairs (4, C) has the factors A and B, then the
    # wrong cell of A and the wrong cell of B, each SHIFT or TURN.
    a, b, kind_a, kind_b = pairs
    a_turns, b_turns = (kind_a == TURN)[:, None], (kind_b == TURN)[:, None]
    axis_a, axis_b = factors.axes[a], factors.axes[b]
    inverse_before = factors.inverse_before[:, samples]
    m = (
        _right_part(factors, a, a_turns, samples)
        @ (inverse_before[a + 1] @ factors.before[b, samples])
        @ _right_part(factors, b, b_turns, samples)
    )
    n = inverse_before[a] @ pose[samples] @ factors.inverse_after[b + 1, samples]
    turn = _turn_of_a(m, n, axis_a, axis_b, b_turns)
    shift = _shift_of_a(m, n, axis_a, axis_b, b_turns)
    x = np.where(a_turns, turn, shift)
    inverse_a = screws(axis_a, np.where(a_turns, 0.0, -x), np.where(a_turns, -x, 0.0))
    remaining, error = read_screws(inverse(m) @ inverse_a @ n, axis_b)
    y = np.where(b_turns, remaining[:, TURN], remaining[:, SHIFT])
    error += np.abs(np.where(b_turns, remaining[:, SHIFT], remaining[:, TURN]))
    return np.array([x, y]), np.asarray(error.max(axis=-1) < SAME_POSE)


def _right_part(
    factors: Factors, which: Integers, turn_is_wrong: NDArray[np.bool_], samples: slice
) -> Matrices:
    # Factors with the wrong cell 0 and the other cell as written: (C, L, 4, 4).
    sizes = factors.sizes[which, :, samples]
    shifts, turns = sizes[:, SHIFT], sizes[:, TURN]
    return screws(
        factors.axes[which],
        np.where(turn_is_wrong, shifts, 0.0),
        np.where(turn_is_wrong, 0.0, turns),
    )


def _turn_of_a(
    m: Matrices, n: Matrices, axis_a: Integers, axis_b: Integers, b_turns: NDArray[np.bool_]
) -> Numbers:
    # The turn (C, L) about A's axis, from directions and points that B does not change. The turn
    # about a from u (in M) to v (in N) is atan2(a·(u×v), u·v − (a·u)(a·v)); the arguments of
    # several pairs (u, v) are summed.
    c = np.arange(len(axis_a))
    unchanged = np.where(b_turns, 0.0, [[1.0, 1.0, 1.0, 0.0]])
    unchanged[c, axis_b] = 1.0
    unchanged[:, 3] = b_turns[:, 0]
    products = (m[..., :3, :] * unchanged[:, None, None]) @ n[..., :3, :].swapaxes(-1, -2)
    one, two = (axis_a + 1) % 3, (axis_a + 2) % 3
    turns: Numbers = np.arctan2(
        products[c, :, one, two] - products[c, :, two, one],
        products[c, :, one, one] + products[c, :, two, two],
    )
    return turns


def _shift_of_a(
    m: Matrices, n: Matrices, axis_a: Integers, axis_b: Integers, b_turns: NDArray[np.bool_]
) -> Numbers:
    # The shift (C, L) along A's axis that takes M's origin to N's origin. If B also shifts, least
    # squares separate the two shifts; along parallel axes this is impossible.
    c = np.arange(len(axis_a))
    way = n[..., :3, 3] - m[..., :3, 3]
    along_b = m[c, :, :3, axis_b]
    cosine = np.where(b_turns, 0.0, along_b[c, :, axis_a])
    rest = way[c, :, axis_a] - cosine * (along_b * way).sum(axis=-1)
    shifts: Numbers = rest / np.maximum(1 - cosine * cosine, SAME_POSE)
    return shifts


# --- Repair the pose of a table by changing one row
#
# The pose is a product of link transforms. If one row alone is wrong, it has to be A = P⁻¹ T S⁻¹,
# where P is the product before it, S the product after it and T the true pose, ``(L, 4, 4)``. If A
# is a link transform, its four numbers are the right row.


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


# --- Repair the joint axes of a table by changing one cell
#
# Shapes: K ``Factors``, n joints.
#
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
