"""Convert an exercise's formulas from syntax trees to SymPy."""

# SymPy never parses a text.

from collections.abc import Callable, Mapping
from decimal import Decimal
from fractions import Fraction
from operator import add, mul, sub, truediv

import sympy

from service.catalogue import Exercise, FormulaGrid
from service.expressions import Expression
from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Operator,
    Pi,
    SymbolNode,
    Unit,
)

FUNCTIONS: Mapping[str, sympy.Function] = {
    "sin": sympy.sin,
    "cos": sympy.cos,
    "tan": sympy.tan,
    "asin": sympy.asin,
    "acos": sympy.acos,
    "atan": sympy.atan,
    "atan2": sympy.atan2,
    "sqrt": sympy.sqrt,
    "abs": sympy.Abs,
    "exp": sympy.exp,
}


_OPERATORS: Mapping[Operator, Callable[[sympy.Expr, sympy.Expr], sympy.Expr]] = {
    "+": add,
    "-": sub,
    "*": mul,
    "/": truediv,
    "^": pow,
}


class Algebra:
    """Converts one exercise's formulas to SymPy; symbols with a positive range are positive.

    With ``home``, all joint variables are 0.
    """

    def __init__(self, exercise: Exercise, *, home: bool = False) -> None:
        self.symbols: dict[str, sympy.Expr] = {
            variable.name: sympy.Symbol(variable.name, positive=True)
            if variable.low > 0
            else sympy.Symbol(variable.name, real=True)
            for variable in exercise.variables
        }
        if home:
            self.symbols |= {joint.variable: sympy.S.Zero for joint in exercise.joints}

    def of(self, formula: Expression) -> sympy.Expr:
        """Return the formula in SymPy; numbers stay exact."""
        return self._node(formula.tree)

    def matrix(self, grid: FormulaGrid) -> sympy.Matrix:
        """Return a grid of formulas as a matrix."""
        return sympy.Matrix([[self.of(formula) for formula in row] for row in grid])

    def _node(self, node: Node) -> sympy.Expr:
        match node:
            case Number(literal=literal):
                exact = Fraction(Decimal(literal))
                return sympy.Rational(exact.numerator, exact.denominator)
            case Pi():
                return sympy.pi
            case SymbolNode(symbol):
                return self.symbols[symbol.name]
            case Unit(operand, unit):
                return self._node(operand) * (sympy.pi / 180 if unit == "deg" else 1)
            case Negation(operand):
                return -self._node(operand)
            case Call(function, arguments):
                return FUNCTIONS[function](*map(self._node, arguments))
            case Binary(operator, left, right):
                return _OPERATORS[operator](self._node(left), self._node(right))
