"""Find the rounded decimals of a formula, and evaluate it with slightly different decimals.

A decimal number with three or more figures is assumed to be rounded or cut off: 1.57 may mean π/2.
The *unit* of a decimal is 1 in its last place, 0.01 for 1.57. A *shift* is the number of units by
which the intended number exceeds the written one.
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

# With two figures, half a unit could be five per cent: 1.6 does not mean π/2.
LEAST_FIGURES: Final = 3


class Decimals:
    """The ``m`` rounded decimals of one formula, from left to right. Immutable.

    ``units`` ``(m,)`` has the unit of each decimal, such as 0.01 for 1.57. ``sign`` is 1 or -1 for
    a formula that is a single decimal, else 0.
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
        """Return the formula's values ``(K, samples)`` after each of K changes of its decimals.

        ``shifts`` ``(K, m)`` says how much to add to each of the m decimals, in units of its last
        place.
        """
        # The shape is ``(K, 1)`` if the formula has no symbols. Undefined values are NaN or
        # infinite, without warnings.
        assert isinstance(self._program, Program)
        moved = self._numbers + shifts * self.units
        named = {name: moved[:, i, None] for i, name in enumerate(self._names)}
        with np.errstate(all="ignore"):
            result: SampleArray = self._program({**values, **named}, {})
        return result


# Grading needs the decimals of the same answer several times.
@lru_cache(maxsize=128)
def decimals_of(expression: Expression) -> Decimals:
    """Return the rounded decimals of an expression (memoized)."""
    return Decimals(expression.tree)


def _name(i: int) -> str:
    # No symbol can have this name.
    return f"~{i}"


def _sign(replaced: Node) -> int:
    match replaced:
        case SymbolNode(Symbol(name)) if name == _name(0):
            return 1
        case Negation(SymbolNode(Symbol(name))) if name == _name(0):
            return -1
        case _:
            return 0


def _with_names(node: Node, found: list[Number]) -> Node:
    """Return ``node`` with symbols for rounded decimals; append the decimals to ``found``."""
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
    """Return 1 in the last place of a decimal: 0.01 for 1.57. Return 0 for a short decimal."""
    # A short decimal has less than three figures.
    # Leading zeros are not figures.
    mantissa, _, exponent = literal.lower().partition("e")
    whole, _, fraction = mantissa.partition(".")
    if not fraction or len((whole + fraction).lstrip("0")) < LEAST_FIGURES:
        return 0.0
    return 10.0 ** (int(exponent or 0) - len(fraction))
