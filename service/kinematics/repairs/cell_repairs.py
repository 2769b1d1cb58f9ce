"""Repair the pose of a table by changing one or two cells.

Shapes: L samples, C pairs of cells; a pose is ``(L, 4, 4)``. Lengths are in a unit that suits the
robot; angles are in radians.
"""

# The pose is a product of factors, screws about x and z in turn (factors). If one factor alone is
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
#
# The unit of length lets one tolerance serve lengths and angles.

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.kinematics.factors import (
    SHIFT,
    TURN,
    CellIndex,
    Factors,
    Integers,
    read_screws,
    screws,
)
from service.kinematics.tolerances import SAME_POSE
from service.kinematics.transforms import Matrices, Numbers, inverse


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
    """Return the values of one or two cells that correct the pose, or None.

    The values are ``(k, L)`` for k cells at L samples.
    """
    # For the values of a CellRepair at other samples.
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
