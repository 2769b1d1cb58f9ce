"""Compute forward kinematics without the tested code."""

# A table is a list of rows of formulas in the column order a, α, d, θ. Formulas are the arithmetic
# that Python and a student's cell have in common; they are read as syntax trees, never run.

import ast
import operator
from collections.abc import Callable, Mapping, Sequence
from functools import cache, reduce

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tests.frame_choice.robots import STANDARD

Numbers = NDArray[np.float64]

_OPERATIONS: dict[type, Callable[..., Numbers]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_FUNCTIONS: dict[str, Callable[..., Numbers]] = {"sqrt": np.sqrt, "atan2": np.arctan2}


def evaluate(text: str, values: Mapping[str, Numbers]) -> Numbers:
    """Return the value of a formula."""
    return _value(_tree(text), values)


@cache
def _tree(text: str) -> ast.expr:
    return ast.parse(text.replace("^", "**"), mode="eval").body


def _value(node: ast.expr, values: Mapping[str, Numbers]) -> Numbers:
    match node:
        case ast.Constant(value=int() | float() as number):
            return np.asarray(float(number))
        case ast.Name(id="pi"):
            return np.asarray(np.pi)
        case ast.Name(id=name):
            return values[name]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, values)
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATIONS[type(op)](_value(left, values), _value(right, values))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return _FUNCTIONS[name](*(_value(argument, values) for argument in arguments))
    raise ValueError(f"no formula: {ast.dump(node)}")


def cell_values(rows: Sequence[Sequence[str]], values: Mapping[str, Numbers]) -> Numbers:
    """Return a table of formulas as numbers."""
    shape = np.broadcast_shapes(*(np.shape(value) for value in values.values()))
    table = np.empty((len(rows), 4, *shape))
    for i, row in enumerate(rows):
        for j, text in enumerate(row):
            table[i, j] = evaluate(text, values)
    return table


def screw_z(d: ArrayLike, theta: ArrayLike) -> Numbers:
    """Return Z = Rot_z(θ) Trans_z(d), ``(..., 4, 4)``."""
    return _screw(2, d, theta)


def screw_x(a: ArrayLike, alpha: ArrayLike) -> Numbers:
    """Return X = Rot_x(α) Trans_x(a), ``(..., 4, 4)``."""
    return _screw(0, a, alpha)


def _screw(axis: int, shift: ArrayLike, angle: ArrayLike) -> Numbers:
    shift, angle = np.broadcast_arrays(shift, angle)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    screw = np.zeros((*angle.shape, 4, 4))
    screw[..., axis, axis] = screw[..., 3, 3] = 1
    screw[..., first, first] = screw[..., second, second] = np.cos(angle)
    screw[..., second, first] = np.sin(angle)
    screw[..., first, second] = -np.sin(angle)
    screw[..., axis, 3] = shift
    return screw


def factors(table: Numbers, convention: str) -> Numbers:
    """Return the factors whose product is the pose of a table."""
    # The table has the shape `(rows, 4, ...)`, the factors `(2 rows, ..., 4, 4)`.
    x = screw_x(table[:, 0], table[:, 1])
    z = screw_z(table[:, 2], table[:, 3])
    pairs = (z, x) if convention == STANDARD else (x, z)
    return np.stack(pairs, axis=1).reshape(-1, *x.shape[1:])


def forward(table: Numbers, convention: str) -> Numbers:
    """Return the pose of the last frame relative to the first frame."""
    return reduce(np.matmul, factors(table, convention))


def inverse(pose: Numbers) -> Numbers:
    """Return the inverse of rigid transforms ``(..., 4, 4)``."""
    rotation = np.swapaxes(pose[..., :3, :3], -1, -2)
    result = np.zeros_like(pose)
    result[..., :3, :3] = rotation
    result[..., :3, 3:] = -rotation @ pose[..., :3, 3:]
    result[..., 3, 3] = 1
    return result
