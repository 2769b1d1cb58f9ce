"""The rule for brackets in formulas that are printed as text, LaTeX or MathML.

An operand needs brackets if it binds less tightly than the operator next to it, or if its sign
would follow that operator. In LaTeX and MathML, a fraction bar replaces brackets.
"""

# A drawn formula needs more brackets than text for the base of a power, because ``90°`` and
# ``1·10⁻³`` consist of several signs.

from typing import Final

from service.expressions.tree import (
    Binary,
    Negation,
    Node,
    Number,
    Pi,
    SymbolNode,
    Unit,
    children,
)

# How tightly a node binds, and how tightly an operand must bind in a place.
SUM, PRODUCT, SIGNED, POWER, ATOM = range(5)
_OPERATORS: Final = {"+": SUM, "-": SUM, "*": PRODUCT, "/": PRODUCT, "^": POWER}


def needs_brackets(node: Node, place: int, *, signed: bool, drawn: bool = True) -> bool:
    """True if ``node`` needs brackets as an operand in a place of this precedence.

    ``signed`` is True if a sign of ``node`` would follow an operator. ``drawn`` is True for LaTeX
    and MathML.
    """
    precedence = ATOM
    # Comparing types takes a third of the time of ``match``.
    kind = type(node)
    if kind is Binary:
        operator = node.operator  # type: ignore[union-attr]
        precedence = POWER if drawn and operator == "/" else _OPERATORS[operator]
    elif kind is Negation:
        precedence = SIGNED
    elif drawn and (kind is Unit or is_power_of_ten(node)):
        precedence = POWER
    return signed or precedence < place


def is_power_of_ten(node: Node) -> bool:
    """True if ``node`` is a number such as 1e-3, which LaTeX and MathML show as 1·10⁻³."""
    return type(node) is Number and "e" in node.literal.lower()


def needs_dot(left: Node, right: Node) -> bool:
    """True if a product needs a dot in LaTeX and MathML, as 2·3 and θ1·(π + 1) do."""
    if begins_with_digit(right):
        return True
    if type(right) is Pi:
        return not _has_symbol(left) and _has_unit(left)
    is_in_brackets = type(right) is Negation or (type(right) is Binary and right.operator in "+-*")
    return is_in_brackets and not _has_symbol(right)


def _has_unit(node: Node) -> bool:
    return type(node) is Unit or any(map(_has_unit, children(node)))


def _has_symbol(node: Node) -> bool:
    return type(node) is SymbolNode or any(map(_has_symbol, children(node)))


def begins_with_digit(node: Node) -> bool:
    """True if ``node`` begins with a digit in LaTeX and MathML."""
    match node:
        case Number():
            return True
        case Unit(operand):
            return begins_with_digit(operand)
        case Binary("^" | "*", left):
            return begins_with_digit(left)
        case Binary("/", left):
            # A product needs a dot before a fraction, too: 2½ is not read as a product.
            return type(left) is not Negation
        case _:
            return False
