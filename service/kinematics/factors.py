"""A table as a product of factors: alternating screw motions about x and z.

A screw motion is a shift along an axis and a turn about it. The factors are X = Trans_x(a) Rot_x(α)
and Z = Rot_z(θ) Trans_z(d).

Shapes: L samples, K factors; a table is ``(rows, 4, L)`` with the columns a, α, d, θ.
"""

# Shift and turn of a factor commute. A standard table is Z_1 X_1 Z_2 X_2 …, a modified table X_0
# Z_1 X_1 Z_2 …. The cells include the joint variables; angles are in radians. Axes are numbered: 0
# is x, 2 is z.

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import A, D, Table, products
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers, inverse

Integers = NDArray[np.int_]

X, Z = 0, 2
# The two cells of a factor: the length of its shift, and the angle of its turn.
SHIFT, TURN = 0, 1

# A row and a column of a table.
CellIndex = tuple[int, int]


@dataclass(frozen=True)
class Factors:
    """The factors of a table: motions along and about x or z whose product is the table's pose."""

    convention: Convention
    # (K, 2, L): the SHIFT and the TURN of each factor.
    sizes: Numbers
    # (K,): 0 for x, 2 for z.
    axes: Integers

    @property
    def table(self) -> Table:
        """The table in numbers, ``(rows, 4, samples)``, with lengths in the unit of the factors."""
        sizes = self.sizes.reshape(-1, 2, 2, self.sizes.shape[-1])
        if self.convention is Convention.STANDARD:
            sizes = sizes[:, ::-1]
        return sizes.reshape(len(sizes), 4, -1)

    @cached_property
    def screws(self) -> Matrices:
        """The K factors as matrices at L samples, ``(K, L, 4, 4)``."""
        return screws(self.axes, self.sizes[:, SHIFT], self.sizes[:, TURN])

    @cached_property
    def before(self) -> Matrices:
        """The product of the first k factors for k = 0..K: ``(K + 1, L, 4, 4)`` at L samples."""
        return products(self.screws)

    @cached_property
    def after(self) -> Matrices:
        """The product of the factors k, k + 1, … for k = 0..K, ``(K + 1, samples, 4, 4)``."""
        reached = np.empty((len(self.axes) + 1, *self.screws.shape[1:]))
        reached[-1] = np.eye(4)
        for k in reversed(range(len(self.axes))):
            np.matmul(self.screws[k], reached[k + 1], out=reached[k])
        return reached

    @cached_property
    def inverse_before(self) -> Matrices:
        """The inverse of each matrix in ``before``."""
        return inverse(self.before)

    @cached_property
    def inverse_after(self) -> Matrices:
        """The inverse of each matrix in ``after``."""
        return inverse(self.after)

    def around(self, factor: int) -> tuple[Matrices, Matrices]:
        """Return the products of all factors before and after ``factor``.

        Each product is ``(L, 4, 4)``, with L samples.
        """
        before = reduce(np.matmul, self.screws[:factor], np.eye(4))
        return before, reduce(np.matmul, self.screws[factor + 1 :], np.eye(4))

    def cell(self, factor: int, kind: int) -> CellIndex:
        """Return the table cell of a factor's SHIFT or TURN."""
        return factor // 2, (A if self.axes[factor] == X else D) + kind

    def position(self, cell: CellIndex) -> tuple[int, int]:
        """Return the factor of a table cell, and whether the cell is its SHIFT or its TURN."""
        row, column = cell
        in_z = column >= D
        z_first = self.convention is Convention.STANDARD
        return 2 * row + (in_z != z_first), column - (D if in_z else A)


def factors_of(table: Table, convention: Convention, unit: float = 1.0) -> Factors:
    """Return the factors of a table ``(rows, 4, samples)``, with lengths measured in ``unit``."""
    sizes = table.reshape(len(table), 2, 2, -1)
    z_first = convention is Convention.STANDARD
    if z_first:
        sizes = sizes[:, ::-1]
    sizes = sizes / np.array([[unit], [1.0]])
    axes = np.tile([Z, X] if z_first else [X, Z], len(table))
    return Factors(convention, sizes.reshape(2 * len(table), 2, -1), axes)


def screws(axes: Integers, shifts: Numbers, turns: Numbers) -> Matrices:
    """Return K screw motions ``(K, L, 4, 4)`` about x, y or z axes, at L samples.

    ``axes`` is ``(K,)``; ``shifts`` and ``turns`` are ``(K, L)``.
    """
    k = np.arange(len(axes))
    one, other = (axes + 1) % 3, (axes + 2) % 3
    cosine, sine = np.cos(turns), np.sin(turns)
    matrices = np.zeros((*shifts.shape, 4, 4))
    matrices[k, :, axes, axes] = 1.0
    matrices[..., 3, 3] = 1.0
    matrices[k, :, one, one] = cosine
    matrices[k, :, other, other] = cosine
    matrices[k, :, one, other] = -sine
    matrices[k, :, other, one] = sine
    matrices[k, :, axes, 3] = shifts
    return matrices


def read_screws(transforms: Matrices, axes: Integers) -> tuple[Numbers, Numbers]:
    """Return each transform's shift and turn about its axis, and its deviation from a screw.

    For K transforms at L samples, ``(K, L, 4, 4)``, the results are ``(K, 2, L)`` and ``(K, L)``.
    """
    # The axes are (K,). The deviation is the tilt of the axis plus the distance of the origin from
    # it.
    k = np.arange(len(axes))
    one, other = (axes + 1) % 3, (axes + 2) % 3
    sizes = np.empty((len(axes), 2, transforms.shape[1]))
    sizes[:, SHIFT] = transforms[k, :, axes, 3]
    sizes[:, TURN] = np.arctan2(transforms[k, :, other, one], transforms[k, :, one, one])
    error = np.abs(transforms[k, :, one, 3]) + np.abs(transforms[k, :, other, 3])
    error += np.abs(transforms[k, :, one, axes]) + np.abs(transforms[k, :, other, axes])
    error += 1 - transforms[k, :, axes, axes]
    return sizes, error
