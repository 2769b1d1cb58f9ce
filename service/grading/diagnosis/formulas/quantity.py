"""Find out if a formula is a length, an angle or a plain number."""

from typing import Final, TypeAlias

from service.expressions import Kind
from service.expressions.tree import Binary, Call, Negation, Node, Number, Pi, SymbolNode, Unit

# None if a formula has no single quantity, or an unknown one: l1 + theta1, l1*l2.
Quantity: TypeAlias = Kind | None

_ANGLE_OF: Final = frozenset({"asin", "acos", "atan", "atan2"})
_NUMBER_OF: Final = frozenset({"sin", "cos", "tan"})
# Deeper than any formula of a student; a longer sum has no quantity.
_DEEPEST: Final = 60


def quantity_of(tree: Node, depth: int = 0) -> Quantity:
    """Return the quantity of a formula: length, angle or plain number; None if it is unknown.

    For example, ``90deg`` is an angle, and ``l1 cos(theta1)`` is a length.
    """
    # The sum of a number and an angle is an angle; the sum of a number and a length is a length.
    if depth > _DEEPEST:
        return None
    match tree:
        case Number():
            return "number"
        case Pi() | Unit():
            return "angle"
        case SymbolNode(symbol):
            return symbol.kind
        case Negation(operand):
            return quantity_of(operand, depth + 1)
        case Binary(operator, left, right):
            return _combined(operator, quantity_of(left, depth + 1), quantity_of(right, depth + 1))
        case Call(function, _):
            if function in _ANGLE_OF:
                return "angle"
            return "number" if function in _NUMBER_OF else None


def _combined(operator: str, left: Quantity, right: Quantity) -> Quantity:
    if left is None or right is None:
        return None
    if right == "number":
        return left if operator != "^" or left == "number" else None
    if operator in "+-":
        return right if left in (right, "number") else None
    if operator == "*":
        return right if left == "number" else None
    return "number" if operator == "/" and left == right else None
