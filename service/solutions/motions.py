"""Multiply rigid motions (turns and shifts) in the form that textbooks print.

Vectors are 3×1, rotations 3×3 matrices of SymPy; angles are in radians.
"""

# A general simplifier takes seconds for six joints, and its result does not look like a textbook's.
# Here the form results from the order of the steps:
# - Quarter turns about a coordinate axis are constant, and C Rot(u, φ) = Rot(C u, φ) C for a
#   constant rotation C. So these turns are moved to the right end; a 90° twist only changes later
#   axes.
# - Consecutive turns about the same axis, with only shifts between them, are combined: their angles
#   are added, which gives c12 and c123 without expanding and collecting sines and cosines.
# - Factors are applied from the right, and products of brackets are not expanded, which gives
#   c1 (c2 (c4 c5 c6 − s4 s6) − s2 s5 c6) − …, as books print the matrix of an arm with a wrist.

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy

from service.solutions import constants

X = sympy.ImmutableMatrix([1, 0, 0])
Y = sympy.ImmutableMatrix([0, 1, 0])
Z = sympy.ImmutableMatrix([0, 0, 1])
ORIGIN = sympy.ImmutableMatrix([0, 0, 0])


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn about the unit vector ``axis`` through the origin."""

    axis: sympy.Matrix
    angle: sympy.Expr


@dataclass(frozen=True, slots=True)
class Shift:
    """A translation."""

    by: sympy.Matrix


@dataclass(frozen=True, slots=True)
class Fixed:
    """A rotation by a constant matrix."""

    rotation: sympy.Matrix


Motion = Turn | Shift | Fixed


@dataclass(frozen=True, slots=True)
class Pose:
    """The result of a product of motions: a rotation and a position."""

    rotation: sympy.Matrix
    position: sympy.Matrix

    def matrix(self) -> sympy.Matrix:
        """Return the homogeneous transform, 4×4."""
        upper = self.rotation.row_join(self.position)
        return upper.col_join(sympy.Matrix([[0, 0, 0, 1]]))


@dataclass(frozen=True, slots=True)
class Normal:
    """A product of motions, sorted so that its constant rotation comes last."""

    # The factors are the shift ``start``, the turns, each followed by a shift, and the rotation
    # ``end``.
    start: sympy.Matrix
    turns: tuple[tuple[Turn, sympy.Matrix], ...]
    end: sympy.Matrix


def inverse(motions: Sequence[Motion]) -> list[Motion]:
    """Return the inverse of the product of ``motions``."""
    return [_inverted(motion) for motion in reversed(motions)]


def _inverted(motion: Motion) -> Motion:
    match motion:
        case Turn(axis, angle):
            return Turn(axis, -angle)
        case Shift(by):
            return Shift(-by)
        case Fixed(rotation):
            return Fixed(rotation.T)


def multiplied(motions: Iterable[Motion]) -> Pose:
    """Return the product of ``motions`` from left to right."""
    normal = normalised(motions)
    rotation, position = normal.end, ORIGIN
    for run in reversed(_runs(normal.turns)):
        whole = rotation_about(run[-1][0].axis, run[-1][0].angle)
        rotation = whole * rotation
        position = whole * (run[-1][1] + position)
        for turn, shift in run[:-1]:
            position += rotation_about(turn.axis, turn.angle) * shift
    return Pose(rotation, normal.start + position)


def normalised(motions: Iterable[Motion]) -> Normal:
    """Return an equal product with quarter turns and fixed rotations moved to the right end."""
    constant = sympy.eye(3)
    shifts, turns = [ORIGIN], list[Turn]()
    for motion in motions:
        match motion:
            case Shift(by):
                shifts[-1] += constant * by
            case Fixed(rotation):
                constant *= rotation
            case Turn(axis, angle):
                rest, quarters = _split(axis, angle)
                if rest != 0:
                    turns.append(_upright(Turn(constant * axis, rest)))
                    shifts.append(ORIGIN)
                constant *= quarters
    return Normal(shifts[0], tuple(zip(turns, shifts[1:], strict=True)), constant)


def _split(axis: sympy.Matrix, angle: sympy.Expr) -> tuple[sympy.Expr, sympy.Matrix]:
    # The angle without its quarter turns, and the rotation by these quarter turns.
    constant, rest = angle.as_independent(*angle.free_symbols, as_Add=True)
    if axis not in (X, Y, Z) or not (2 * constant / sympy.pi).is_Integer:
        return angle, sympy.eye(3)
    return rest, rotation_about(axis, constant)


def _upright(turn: Turn) -> Turn:
    # An equal turn whose axis has no minus sign in its first nonzero number.
    first = next(number for number in turn.axis if number != 0)
    return Turn(-turn.axis, -turn.angle) if first.could_extract_minus_sign() else turn


def _runs(turns: Sequence[tuple[Turn, sympy.Matrix]]) -> list[list[tuple[Turn, sympy.Matrix]]]:
    # Group consecutive turns about the same axis; in a group, replace angles by running totals.
    runs: list[list[tuple[Turn, sympy.Matrix]]] = []
    for turn, shift in turns:
        if runs and runs[-1][-1][0].axis == turn.axis:
            so_far = runs[-1][-1][0].angle
            runs[-1].append((Turn(turn.axis, so_far + turn.angle), shift))
        else:
            runs.append([(turn, shift)])
    return runs


def rotation_about(axis: sympy.Matrix, angle: sympy.Expr) -> sympy.Matrix:
    """Return Rot(u, φ) = cos φ I + sin φ [u] + (1 − cos φ) u uᵀ.

    Source: Lynch and Park, *Modern Robotics*, eq. 3.51 (Rodrigues' formula).
    """
    x, y, z = axis
    skew = sympy.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    along = axis * axis.T
    cos, sin = constants.folded(sympy.cos(angle)), constants.folded(sympy.sin(angle))
    return cos * (sympy.eye(3) - along) + sin * skew + along
