"""Build functions such as sec, pow and hypot from the functions that a tree may contain.

For example, sec(x) gets the same tree as 1/cos(x).
"""

from collections.abc import Sequence
from typing import Final

from service.expressions.tree import Binary, Call, Node, Number, Operator

RECIPROCALS: Final = {"sec": "cos", "csc": "sin", "cot": "tan"}
_OPERATORS: Final[dict[str, Operator]] = {
    "pow": "^", "quotient": "/", "sum": "+", "product": "*",
}  # fmt: skip


def build_function(name: str, arguments: Sequence[Node], start: int, end: int) -> Node:
    """Return the tree of a function such as sec. The number of arguments must be correct."""
    if name in RECIPROCALS:
        one = Number(1.0, "1", start, start)
        return Binary("/", one, Call(RECIPROCALS[name], tuple(arguments), start, end), start, end)
    if name == "hypot":
        squares = [
            Binary("^", side, Number(2.0, "2", side.end, side.end), side.start, side.end)
            for side in arguments
        ]
        total = Binary("+", squares[0], squares[1], start, end)
        return Call("sqrt", (total,), start, end)
    whole = arguments[0]
    for argument in arguments[1:]:
        whole = Binary(_OPERATORS[name], whole, argument, start, end)
    return whole
