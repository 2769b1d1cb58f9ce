"""Evaluate many trees for one value of each symbol, in plain floats.

The trees share most of their nodes, so the value of a shared node is computed once. To evaluate one
tree at many samples, use ``samples``.
"""

import math
from collections.abc import Callable, Mapping
from operator import add, mul, sub, truediv
from typing import Final

from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    SymbolNode,
    Unit,
    children,
)

Known = dict[int, float]

_FUNCTIONS: Final[dict[str, Callable[..., float]]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos,
    "atan": math.atan, "atan2": math.atan2, "sqrt": math.sqrt, "abs": abs, "exp": math.exp,
}  # fmt: skip
# math.pow raises an error for a root of a negative number; ** would return a complex number.
_OPERATORS: Final[dict[str, Callable[[float, float], float]]] = {
    "+": add, "-": sub, "*": mul, "/": truediv, "^": math.pow,
}  # fmt: skip


def known_values(tree: Node, at: Mapping[str, float]) -> Known:
    """Map the id of each node of ``tree`` to its value; ``at`` has the value of each symbol.

    The ids are valid only as long as the tree exists.
    """
    known: Known = {}
    _learn(tree, at, known)
    return known


def _learn(node: Node, at: Mapping[str, float], known: Known) -> None:
    for child in children(node):
        _learn(child, at, known)
    known[id(node)] = value_at(node, at, known)


def value_at(node: Node, at: Mapping[str, float], known: Known) -> float:
    """Return the value of ``node`` for the symbols' values ``at``; nan if it is undefined.

    Nodes whose ids are in ``known`` are not evaluated again.
    """
    try:
        return _value(node, at, known)
    except (ValueError, ArithmeticError):
        return math.nan


def _value(node: Node, at: Mapping[str, float], known: Known) -> float:
    value = known.get(id(node))
    if value is not None:
        return value
    if isinstance(node, Binary):
        left, right = _value(node.left, at, known), _value(node.right, at, known)
        return _OPERATORS[node.operator](left, right)
    if isinstance(node, Call):
        return _FUNCTIONS[node.function](*[_value(part, at, known) for part in node.arguments])
    if isinstance(node, SymbolNode):
        return at[node.symbol.name]
    if isinstance(node, Number):
        return node.value
    if isinstance(node, Negation):
        return -_value(node.operand, at, known)
    if isinstance(node, Unit):
        operand = _value(node.operand, at, known)
        return math.radians(operand) if node.unit == "deg" else operand
    return math.pi
