"""A tree -> a function of the symbols' values, over all samples at once.

Each part of the tree becomes a closure. Parts without symbols are computed once, here. Equal parts
share a key, so that a `memo` handed to several expressions computes cos(theta1) once for all.
"""

from collections.abc import Callable, Mapping
from math import isfinite, pi
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from service.expressions.tree import Binary, Call, Negation, Node, Number, Unit, Variable

Samples = NDArray[np.float64]
Values = Mapping[str, Samples]
Memo = dict[str, Any]
Program = Callable[[Values, Memo], Any]
Function = Callable[..., Any]

_BINARY: Final[dict[str, np.ufunc]] = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "^": np.power,
}
_FUNCTIONS: Final[dict[str, np.ufunc]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "sqrt": np.sqrt,
    "abs": np.absolute,
    "exp": np.exp,
}
_RADIANS: Final = {"deg": pi / 180, "rad": 1.0}


# Where these meet a value that is not finite, they may answer with one that is: 1/(1/0) is no 0.
_FORGIVING: Final = frozenset({"/", "^", "atan", "atan2", "exp"})
# These may be undefined, or beyond all bounds, where what they work on is neither.
_DOUBTFUL: Final = frozenset({"/", "^", "tan", "asin", "acos", "sqrt", "exp"})


class _Part(NamedTuple):
    """A compiled part of a tree: its key, its program, and whether it may be undefined."""

    key: str
    program: Program | float
    doubtful: bool


def compile_tree(tree: Node) -> Program | float:
    """Return the program of `tree`, or its value where it has no symbols.

    A program takes the values by symbol name, each of shape (samples,), and the memo. Where a part
    is undefined, so is the whole.
    """
    with np.errstate(all="ignore"):
        return _compile(tree).program


def _compile(node: Node) -> _Part:
    # A chain of types takes a third of the time of `match`, and this is on the grading path.
    if isinstance(node, Binary):
        left, right = _compile(node.left), _compile(node.right)
        if node.operator == "^" and right.program == 2.0:
            return _apply(np.square, "²", left)
        return _apply(_BINARY[node.operator], node.operator, left, right)
    if isinstance(node, Variable):
        return _Part(node.symbol.name, _load(node.symbol.name), False)
    if isinstance(node, Call):
        return _apply(_FUNCTIONS[node.function], node.function, *map(_compile, node.arguments))
    if isinstance(node, Number):
        return _constant(node.value)
    if isinstance(node, Negation):
        return _apply(np.negative, "-", _compile(node.operand))
    if isinstance(node, Unit):
        return _apply(np.multiply, "*", _compile(node.operand), _constant(_RADIANS[node.unit]))
    return _constant(pi)


def _constant(value: float) -> _Part:
    return _Part(repr(value), value, not isfinite(value))


def _apply(function: Function, name: str, *operands: _Part) -> _Part:
    """Return the application of `function`, folded where every operand is a constant."""
    doubtful = any(operand.doubtful for operand in operands)
    if doubtful and name in _FORGIVING:
        function = _strict(function)
    doubtful = doubtful or name in _DOUBTFUL
    if len(operands) == 1:
        ((key, operand, _),) = operands
        if isinstance(operand, float):
            return _constant(float(function(operand)))
        key = f"{name}({key})"
        return _Part(key, _unary(function, key, operand), doubtful)
    (left_key, left, _), (right_key, right, _) = operands
    if isinstance(left, float) and isinstance(right, float):
        return _constant(float(function(left, right)))
    key = f"{name}({left_key},{right_key})"
    return _Part(key, _binary(function, key, left, right), doubtful)


def _strict(function: Function) -> Function:
    """Return `function`, undefined wherever one of its operands is not finite."""

    def apply(*operands: Any) -> Any:
        finite = np.isfinite(operands[0])
        for operand in operands[1:]:
            finite = finite & np.isfinite(operand)
        return np.where(finite, function(*operands), np.nan)

    return apply


def _load(name: str) -> Program:
    def load(values: Values, _memo: Memo) -> Any:
        return values[name]

    return load


def _unary(function: Function, key: str, operand: Any) -> Program:
    def apply(values: Values, memo: Memo) -> Any:
        result = memo.get(key)
        if result is None:
            result = memo[key] = function(operand(values, memo))
        return result

    return apply


def _binary(function: Function, key: str, left: Any, right: Any) -> Program:
    # numpy takes an array of no dimensions faster than a Python float.
    if isinstance(right, float):
        constant = np.asarray(right)

        def apply_right(values: Values, memo: Memo) -> Any:
            result = memo.get(key)
            if result is None:
                result = memo[key] = function(left(values, memo), constant)
            return result

        return apply_right
    if isinstance(left, float):
        constant = np.asarray(left)

        def apply_left(values: Values, memo: Memo) -> Any:
            result = memo.get(key)
            if result is None:
                result = memo[key] = function(constant, right(values, memo))
            return result

        return apply_left

    def apply(values: Values, memo: Memo) -> Any:
        result = memo.get(key)
        if result is None:
            result = memo[key] = function(left(values, memo), right(values, memo))
        return result

    return apply
