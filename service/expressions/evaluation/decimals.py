"""The rounded decimals of a formula, and its values where they were other numbers.

A decimal number with three or more figures is taken for one that was rounded or cut off: 1.57 may
stand for π/2. The *unit* of a decimal is 1 in the last place that was written, 0.01 for 1.57. A
*shift* says by how many units the intended number is larger than the one that was written.
"""

from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from service.expressions.evaluation.samples import (
    Program,
    SampleArray,
    SymbolValues,
    compile_tree,
)
from service.expressions.reader import Expression
from service.expressions.tree import Binary, Call, Negation, Node, Number, SymbolNode, Unit
from service.expressions.vocabulary.symbols import Symbol

# Half of two figures would be five per cent: 1.6 is no π/2.
LEAST_FIGURES: Final = 3


class Decimals:
    """The rounded decimals of one formula, from left to right. Immutable.

    ``units`` ``(m,)`` are their units; ``m`` may be 0. ``sign`` is that of the only one where the
    formula is nothing else, and 0 for any other formula.
    """

    __slots__ = ("_names", "_numbers", "_program", "sign", "units")

    def __init__(self, tree: Node) -> None:
        found: list[Number] = []
        replaced = _with_names(tree, found)
        self.units: Final = np.array([_unit(number.literal) for number in found])
        self._numbers: Final = np.array([number.value for number in found])
        self._names: Final = [_name(i) for i in range(len(found))]
        self._program: Final = compile_tree(replaced) if found else 0.0
        self.sign: Final = _sign(replaced)

    def shifted(self, shifts: NDArray[np.float64], values: SymbolValues) -> SampleArray:
        """The values ``(K, samples)`` of the formula with its decimals moved in K ways.

        ``(K, 1)`` where no symbol is used. ``shifts`` is ``(K, m)``. NaN or infinite where the
        formula is undefined; nothing warns.
        """
        assert isinstance(self._program, Program)
        moved = self._numbers + shifts * self.units
        named = {name: moved[:, i, None] for i, name in enumerate(self._names)}
        with np.errstate(all="ignore"):
            result: SampleArray = self._program({**values, **named}, {})
        return result


# The grading asks for those of one answer several times.
@lru_cache(maxsize=128)
def decimals_of(expression: Expression) -> Decimals:
    """The rounded decimals of an expression."""
    return Decimals(expression.tree)


def _name(i: int) -> str:
    # No symbol is called so.
    return f"~{i}"


def _sign(replaced: Node) -> int:
    """1 or -1 where nothing but a decimal stands in the tree, with names for them; else 0."""
    match replaced:
        case SymbolNode(Symbol(name)) if name == _name(0):
            return 1
        case Negation(SymbolNode(Symbol(name))) if name == _name(0):
            return -1
        case _:
            return 0


def _with_names(node: Node, found: list[Number]) -> Node:
    """``node`` with names for its rounded decimals, which are added to ``found``."""
    match node:
        case Number():
            if _unit(node.literal) == 0.0:
                return node
            found.append(node)
            return SymbolNode(Symbol(_name(len(found) - 1), "number"))
        case Binary(operator, left, right):
            return Binary(operator, _with_names(left, found), _with_names(right, found))
        case Negation(operand):
            return Negation(_with_names(operand, found))
        case Unit(operand, unit):
            return Unit(_with_names(operand, found), unit)
        case Call(function, arguments):
            return Call(function, tuple(_with_names(each, found) for each in arguments))
        case _:
            return node


def _unit(literal: str) -> float:
    """The unit of a decimal number with enough figures; 0 for a number that is exact as written.

    Zeros before the first other digit are no figures.
    """
    mantissa, _, exponent = literal.lower().partition("e")
    whole, _, fraction = mantissa.partition(".")
    if not fraction or len((whole + fraction).lstrip("0")) < LEAST_FIGURES:
        return 0.0
    return 10.0 ** (int(exponent or 0) - len(fraction))
