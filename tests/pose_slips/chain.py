"""Forward kinematics of a table in SymPy, as a product of rotations and translations."""

from collections.abc import Sequence
from functools import reduce
from typing import Any

import sympy as sp

Row = Sequence[sp.Expr]


def _about(axis: str, angle: sp.Expr) -> Any:
    c, s = sp.cos(angle), sp.sin(angle)
    if axis == "x":
        return sp.Matrix([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
    return sp.Matrix([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def _along(axis: str, length: sp.Expr) -> Any:
    shift = sp.eye(4)
    shift["xyz".index(axis), 3] = length
    return shift


def link(row: Row, convention: str) -> Any:
    """Return the link transform of a row (a, α, d, θ)."""
    a, alpha, d, theta = row
    x = _along("x", a) * _about("x", alpha)
    z = _about("z", theta) * _along("z", d)
    return z * x if convention == "standard" else x * z


def pose(rows: Sequence[Row], convention: str) -> Any:
    """Return the product of all link transforms."""
    return reduce(lambda reached, row: reached * link(row, convention), rows, sp.eye(4))


def printed(matrix: Any) -> list[list[str]]:
    """Return the entries as text, as a program prints them."""
    return [[str(matrix[i, j]) for j in range(matrix.cols)] for i in range(matrix.rows)]
