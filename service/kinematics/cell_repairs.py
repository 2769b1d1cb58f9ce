"""The cells that a table would only need to have different: one of them, or two.

The pose is a product of factors, screws about x and z in turn (``factors``). If one factor alone is
wrong, it has to be F = P⁻¹ T S⁻¹, where P is the product before it, S that behind it and T the true
pose. If F is a screw of that factor's axis, its shift and its turn are what the two cells should
be; where one of them is what was written, the other cell alone mends the table.

If one cell is wrong in each of two factors, A(x) M B(y) = N, where N = P⁻¹ T S⁻¹ as before and M is
what stands between, the cells that are right included; A and B are a turn or a shift. A turn leaves
a point and a direction of its axis as they are, a shift all directions. So what A must do to what B
leaves alone gives x; what then remains is B, if it is of its kind at all.

Shapes: L samples, C candidates; a pose is ``(L, 4, 4)``; angles in radians. Lengths should
be measured in one that suits the robot, so that one tolerance serves them and angles.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.kinematics.factors import (
    SHIFT,
    TURN,
    Cell,
    Factors,
    Integers,
    read_screws,
    screws,
)
from service.kinematics.transforms import Matrices, Numbers, inverse

SAME = 1e-7


@dataclass(frozen=True, slots=True)
class Mend:
    """Other values ``(k, L)`` for k cells, each a row and a column, that make the pose right.

    Whether such a value may stand there (a constant, or the joint variable plus one) is not looked
    into.
    """

    cells: tuple[Cell, ...]
    values: Numbers


def one_factor_mends(factors: Factors, pose: Matrices) -> list[Mend]:
    """The ways to mend one factor, by one of its cells or by both: the former come first."""
    needed = inverse(factors.before[:-1]) @ pose @ inverse(factors.behind[1:])
    sizes, missed = read_screws(needed, factors.axes)
    changed = ~_equal(sizes, factors.sizes)
    mends = []
    for k in np.flatnonzero((missed.max(axis=-1) < SAME) & changed.any(axis=-1)).tolist():
        kinds = np.flatnonzero(changed[k]).tolist()
        mends.append(Mend(tuple(factors.cell(k, kind) for kind in kinds), sizes[k, kinds]))
    return sorted(mends, key=lambda mend: len(mend.cells))


def two_factor_mends(factors: Factors, pose: Matrices) -> Iterator[Mend]:
    """The ways to mend one cell in each of two factors.

    Most pairs of cells fail in the first sample; the others are looked at in all of them.
    """
    pairs = _all_pairs(len(factors.axes))
    first = slice(0, 1)
    _, possible = _solved(factors.at(first), pose[first], pairs)
    pairs = pairs[:, possible]
    if not pairs.size:
        return
    values, solved = _solved(factors, pose, pairs)
    for c in np.flatnonzero(solved).tolist():
        one, other, kind, other_kind = pairs[:, c].tolist()
        yield Mend((factors.cell(one, kind), factors.cell(other, other_kind)), values[:, c])


def mended(factors: Factors, pose: Matrices, cells: Sequence[Cell]) -> Numbers | None:
    """What these cells, one or two, must be for the pose to be right: ``(k, L)``, or None.

    The same as the values of the Mend with these cells, at other samples.
    """
    places = [factors.place(cell) for cell in cells]
    (one, kind), (other, other_kind) = min(places), max(places)
    if one != other:
        values, solved = _solved(factors, pose, np.array([[one], [other], [kind], [other_kind]]))
        values = values[:, 0] if places[0] == (one, kind) else values[::-1, 0]
        return values if solved[0] else None
    before, behind = factors.around(one)
    needed = inverse(before) @ pose @ inverse(behind)
    sizes, missed = read_screws(needed[None], factors.axes[one : one + 1])
    if missed.max() >= SAME:
        return None
    return sizes[0, [kind for _, kind in places]]


def _equal(sizes: Numbers, written: Numbers) -> NDArray[np.bool_]:
    """Which shifts and turns ``(K, 2, L)`` are as written: ``(K, 2)``."""
    off = sizes - written
    off[:, TURN] -= 2 * np.pi * np.round(off[:, TURN] / (2 * np.pi))
    return np.asarray(np.abs(off).max(axis=-1) < SAME)


# Pairs of cells are arrays ``(4, C)``: two factors, and of each whether its SHIFT or TURN is wrong.
_Pairs = Integers


def _all_pairs(count: int) -> _Pairs:
    one, other = np.triu_indices(count, 1)
    kinds = np.repeat([[SHIFT, SHIFT, TURN, TURN], [SHIFT, TURN, SHIFT, TURN]], len(one), axis=1)
    return np.concatenate([np.tile([one, other], 4), kinds])


def _solved(factors: Factors, pose: Matrices, pairs: _Pairs) -> tuple[Numbers, NDArray[np.bool_]]:
    """X and y of each pair, ``(2, C, L)``, and whether they solve it in all samples, ``(C,)``."""
    one, other, kind, other_kind = pairs
    x_turns, y_turns = (kind == TURN)[:, None], (other_kind == TURN)[:, None]
    near, far = factors.axes[one], factors.axes[other]
    back = inverse(factors.before)
    middle = (
        _right_part(factors, one, x_turns)
        @ (back[one + 1] @ factors.before[other])
        @ _right_part(factors, other, y_turns)
    )
    target = back[one] @ pose @ inverse(factors.behind[1:])[other]
    turn = _carrying_turn(middle, target, near, far, y_turns)
    shift = _carrying_shift(middle, target, near, far, y_turns)
    x = np.where(x_turns, turn, shift)
    undone = screws(near, np.where(x_turns, 0.0, -x), np.where(x_turns, -x, 0.0))
    left, missed = read_screws(inverse(middle) @ undone @ target, far)
    y = np.where(y_turns, left[:, TURN], left[:, SHIFT])
    missed += np.abs(np.where(y_turns, left[:, SHIFT], left[:, TURN]))
    return np.array([x, y]), np.asarray(missed.max(axis=-1) < SAME)


def _right_part(factors: Factors, which: Integers, turn_is_wrong: NDArray[np.bool_]) -> Matrices:
    """Of each factor what its right cell does, ``(C, L, 4, 4)``."""
    shifts, turns = factors.sizes[which, SHIFT], factors.sizes[which, TURN]
    return screws(
        factors.axes[which],
        np.where(turn_is_wrong, shifts, 0.0),
        np.where(turn_is_wrong, 0.0, turns),
    )


def _carrying_turn(
    middle: Matrices, target: Matrices, near: Integers, far: Integers, y_turns: NDArray[np.bool_]
) -> Numbers:
    """The turn about the near axis that carries what B leaves alone from M to N: ``(C, L)``.

    For u → v about the axis a it is atan2(a·(u×v), u·v − (a·u)(a·v)); several are summed.
    """
    here = np.arange(len(near))
    left_alone = np.where(y_turns, 0.0, [[1.0, 1.0, 1.0, 0.0]])
    left_alone[here, far] = 1.0
    left_alone[:, 3] = y_turns[:, 0]
    carried = (middle[..., :3, :] * left_alone[:, None, None]) @ target[..., :3, :].swapaxes(-1, -2)
    one, two = (near + 1) % 3, (near + 2) % 3
    turns: Numbers = np.arctan2(
        carried[here, :, one, two] - carried[here, :, two, one],
        carried[here, :, one, one] + carried[here, :, two, two],
    )
    return turns


def _carrying_shift(
    middle: Matrices, target: Matrices, near: Integers, far: Integers, y_turns: NDArray[np.bool_]
) -> Numbers:
    """The shift along the near axis that carries the origin of M to that of N: ``(C, L)``.

    Where B shifts too, the two shares of the way are told apart by least squares; along parallel
    axes they cannot be.
    """
    here = np.arange(len(near))
    way = target[..., :3, 3] - middle[..., :3, 3]
    along_far = middle[here, :, :3, far]
    cosine = np.where(y_turns, 0.0, along_far[here, :, near])
    rest = way[here, :, near] - cosine * (along_far * way).sum(axis=-1)
    shifts: Numbers = rest / np.maximum(1 - cosine * cosine, SAME)
    return shifts
