"""Convert SymPy expressions to syntax trees, in a textbook's order and shorthand.

A shorthand such as c12 is used only if a reader gives it the same meaning.
"""

# ``service.expressions`` prints these trees. A shorthand is a symbol in the tree; it is used only
# if the reader of entries would read c12 with the same meaning.

from collections.abc import Callable, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import reduce

import sympy

from service.catalogue import Exercise
from service.expressions import ExpressionError, Symbol, Vocabulary, read
from service.expressions.printing.text import to_text
from service.expressions.tree import Binary, Call, Negation, Node, Number, Pi, SymbolNode, Unit
from service.solutions import constants
from service.solutions.algebra import FUNCTIONS

_NAMES = {function: name for name, function in FUNCTIONS.items()}
_TRIGONOMETRIC = (sympy.sin, sympy.cos, sympy.tan)
# Fractions with these denominators stay fractions; others become finite decimals if possible.
_PLAIN_DENOMINATORS = (1, 2, 3, 4)

# A formula with more nodes would be longer than an answer may be.
_MOST_NODES = 1000

# The sort key of a factor in a product: rank, joints, True for a sine, text.
FactorOrder = tuple[int, list[int], bool, str]


class TooLongError(Exception):
    """The formula is longer than an answer may be."""


class Writer:
    """Converts one exercise's SymPy expressions to syntax trees.

    ``used`` maps each shorthand used so far to its meaning.
    """

    def __init__(self, exercise: Exercise) -> None:
        self.used: dict[str, str] = {}
        self._vocabulary = exercise.vocabulary
        self._symbols = {symbol.name: symbol for symbol in exercise.vocabulary.symbols}
        ordered = sorted(exercise.variables, key=lambda variable: variable.joint or 0)
        self._order = {variable.name: i for i, variable in enumerate(ordered)}

    def number(self, expression: sympy.Expr) -> Node:
        """Return the tree of a number or a length. May raise TooLongError."""
        if constants.is_unwieldy(expression):
            expression = constants.rounded(expression)
        if _size(expression, {}) > _MOST_NODES:
            raise TooLongError
        return self._node(_without_negative_brackets(expression))

    def _node(self, expression: sympy.Expr) -> Node:
        if isinstance(expression, sympy.Add):
            return _signed_sum(sorted(expression.args, key=self._term_order), self._node)
        if isinstance(expression, sympy.Symbol):
            return SymbolNode(self._symbols[expression.name])
        if isinstance(expression, sympy.Pow):
            return self._power(*expression.args)
        if expression == sympy.pi:
            return Pi()
        if isinstance(expression, sympy.Mul | sympy.Rational):
            return self._product(expression)
        return self._call(expression)

    def angle(self, expression: sympy.Expr) -> Node:
        """Return the tree of an angle."""
        # A plain number gets the unit rad, so that it means the same to a student who works in
        # degrees.

        def term(value: sympy.Expr) -> Node:
            node = self._node(value)
            return Unit(node, "rad") if value.is_Rational and value != 0 else node

        terms = sympy.Add.make_args(expression)
        ordered = sorted(
            terms, key=lambda each: (_negative(each), each.is_number, *self._term_order(each))
        )
        return _signed_sum(ordered, term)

    def _product(self, expression: sympy.Expr) -> Node:
        factor, rest = expression.as_coeff_Mul()
        if factor < 0:
            return _negated(self._node(-expression))
        whole = factor.q in _PLAIN_DENOMINATORS or _decimal(factor) is None
        above, below = (
            ([sympy.Integer(factor.p)], [sympy.Integer(factor.q)]) if whole else ([factor], [])
        )
        for each in sympy.Mul.make_args(rest):
            divides = isinstance(each, sympy.Pow) and _negative(each.exp)
            (below if divides else above).append(1 / each if divides else each)
        upper = self._chain([each for each in above if each != 1])
        lower = [each for each in below if each != 1]
        return Binary("/", upper, self._chain(lower)) if lower else upper

    def _chain(self, factors: Sequence[sympy.Expr]) -> Node:
        # The factors are not fractions.
        nodes = [
            _number(each) if isinstance(each, sympy.Rational) else self._node(each)
            for each in sorted(factors, key=self._factor_order)
        ]
        return reduce(lambda left, right: Binary("*", left, right), nodes or [_number(sympy.S.One)])

    def _power(self, base: sympy.Expr, exponent: sympy.Expr) -> Node:
        if _negative(exponent):
            return Binary("/", _number(sympy.S.One), self._node(base**-exponent))
        if exponent == sympy.Rational(1, 2):
            return Call("sqrt", (self._node(base),))
        return Binary("^", self._node(base), self._node(exponent))

    def _call(self, expression: sympy.Expr) -> Node:
        name = _NAMES[expression.func]
        if not isinstance(expression, _TRIGONOMETRIC):
            return Call(name, tuple(map(self._node, expression.args)))
        call = Call(name, (self.angle(expression.args[0]),))
        short = self._shorthand(name, sympy.Add.make_args(expression.args[0]))
        if short is None or not _reads_as(short, call, self._vocabulary):
            return call
        self.used[short] = to_text(call)
        return SymbolNode(Symbol(short, "number"))

    def _shorthand(self, function: str, terms: Sequence[sympy.Expr]) -> str | None:
        # The shorthand for a function of a sum of joint angles, such as c12.
        symbols = [self._symbols.get(str(term)) for term in terms]
        joints = [symbol.joint for symbol in symbols if symbol and symbol.joint is not None]
        if function == "tan" or len(joints) < len(terms):
            return None
        return function[0] + "".join(map(str, sorted(joints)))

    def _term_order(self, term: sympy.Expr) -> tuple[bool, list[FactorOrder], list[int], str]:
        # Plus before minus, then lengths before sines, then joints.
        factors = sorted(map(self._factor_order, sympy.Mul.make_args(term)))
        joints = sorted(self._order[symbol.name] for symbol in term.free_symbols)
        return _negative(term), [each for each in factors if each[0] > 1], joints, str(term)

    def _factor_order(self, factor: sympy.Expr) -> FactorOrder:
        # Numbers, symbols, sines and cosines (by joints), brackets.
        base = factor.base if isinstance(factor, sympy.Pow) else factor
        is_symbol, is_turn = isinstance(base, sympy.Symbol), isinstance(base, _TRIGONOMETRIC)
        rank = (bool(base.is_number), is_symbol, is_turn, True).index(True)
        orders = sorted(self._order[symbol.name] for symbol in base.free_symbols)
        return rank, orders, isinstance(base, sympy.sin), str(base)


def _signed_sum(terms: Sequence[sympy.Expr], write: Callable[[sympy.Expr], Node]) -> Node:
    signed = [(_negative(term), write(-term if _negative(term) else term)) for term in terms]
    negative, first = signed[0]
    result = _negated(first) if negative else first
    for negative, node in signed[1:]:
        result = Binary("-" if negative else "+", result, node)
    return result


def _negative(term: sympy.Expr) -> bool:
    return bool(term.as_coeff_Mul()[0] < 0)


def _size(expression: sympy.Expr, known: dict[sympy.Expr, int]) -> int:
    # ``known`` memoizes subexpressions.
    if expression not in known:
        known[expression] = 1 + sum(_size(part, known) for part in expression.args)
    return known[expression]


def _negated(node: Node) -> Node:
    # A minus before the first factor: −c1 s2, not −(c1 s2).
    if isinstance(node, Binary) and node.operator in ("*", "/"):
        return Binary(node.operator, _negated(node.left), node.right)
    return Negation(node)


def _without_negative_brackets(expression: sympy.Expr) -> sympy.Expr:
    # −s2 (a + b) for s2 (−a − b).
    def turned(product: sympy.Expr) -> sympy.Expr:
        factors = [
            -each if isinstance(each, sympy.Add) and all(map(_negative, each.args)) else each
            for each in product.args
        ]
        changed = sum(a is not b for a, b in zip(factors, product.args, strict=True))
        return sympy.Mul(*factors, sympy.S.NegativeOne**changed)

    return expression.replace(lambda each: isinstance(each, sympy.Mul), turned)


def _number(value: sympy.Rational) -> Node:
    # A whole number or a finite decimal, which must not be negative.
    literal = str(value.p) if value.q == 1 else _decimal(value)
    assert literal is not None
    return Number(float(literal), literal)


def _decimal(value: sympy.Rational) -> str | None:
    exact = Fraction(int(value.p), int(value.q))
    for digits in range(constants.DECIMALS + 1):
        scaled = exact * 10**digits
        if scaled.denominator == 1:
            return f"{Decimal(scaled.numerator).scaleb(-digits):f}"
    return None


def _reads_as(text: str, tree: Node, vocabulary: Vocabulary) -> bool:
    try:
        return read(text, vocabulary).tree == tree
    except ExpressionError:
        return False
