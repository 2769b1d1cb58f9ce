"""The value of a tree at one point, where many trees are tried that share most of their nodes.

A program (see ``samples``) evaluates one tree at many samples. Here many trees are evaluated at one
point, in plain floats; the known values of one tree's nodes serve all trees built from them.
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
# math.pow refuses a root of a negative number; ** would answer with a complex one.
_JOINED: Final[dict[str, Callable[[float, float], float]]] = {
    "+": add, "-": sub, "*": mul, "/": truediv, "^": math.pow,
}  # fmt: skip


def known_values(tree: Node, at: Mapping[str, float]) -> Known:
    """The value of each node of ``tree`` by the node's id, for as long as the tree lives."""
    known: Known = {}
    _learn(tree, at, known)
    return known


def _learn(node: Node, at: Mapping[str, float], known: Known) -> None:
    for child in children(node):
        _learn(child, at, known)
    known[id(node)] = value_at(node, at, known)


def value_at(node: Node, at: Mapping[str, float], known: Known) -> float:
    """The value of ``node`` where the symbols have the values ``at``; nan where it has none.

    A node whose id is in ``known`` is not evaluated again.
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
        return _JOINED[node.operator](left, right)
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
