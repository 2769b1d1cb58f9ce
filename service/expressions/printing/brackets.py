"""The one rule for brackets of the three printers.

An operand stands in brackets where it binds less than its place needs, and where a sign would
stand behind an operator. A drawn formula (LaTeX, MathML) needs fewer of them than text: the bar of
a fraction groups what a ``/`` does not. But a power needs more: ``90°`` and ``1·10⁻³`` are more
than one sign there.
"""

from typing import Final

from service.expressions.tree import Binary, Negation, Node, Number, Unit

# How tightly a form binds, and how tightly an operand has to bind in a place.
SUM, PRODUCT, SIGNED, POWER, ATOM = range(5)
_OPERATORS: Final = {"+": SUM, "-": SUM, "*": PRODUCT, "/": PRODUCT, "^": POWER}


def needs_brackets(node: Node, place: int, *, signed: bool, drawn: bool = True) -> bool:
    """Whether ``node`` needs brackets as an operand in ``place``, in a drawn formula or in text.

    ``signed`` tells whether it would put a sign behind an operator.
    """
    precedence = ATOM
    # A chain of types takes a third of the time of ``match``.
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
    """Whether ``node`` is a number that is drawn as a product: ``1e-3``."""
    return type(node) is Number and "e" in node.literal.lower()


def begins_with_digit(node: Node) -> bool:
    """Whether ``node`` is drawn with a digit first, so that a product before it needs a dot."""
    match node:
        case Number():
            return True
        case Unit(operand):
            return begins_with_digit(operand)
        case Binary("^" | "*", left):
            return begins_with_digit(left)
        case Binary("/", left):
            # A product needs its dot before a bar, too: 2½ is no product.
            return type(left) is not Negation
        case _:
            return False
