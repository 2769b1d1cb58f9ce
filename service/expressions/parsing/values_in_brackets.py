"""Refuse two values that look like a product: ``90° (π/2)``, ``a2 (0.4318)``, ``θ1 (0)``.

Students write a value in brackets after its name, or after the same angle in another unit.
"""

from typing import Final

from service.expressions.errors import UnreadableError
from service.expressions.tree import Call, Negation, Node, Number, Pi, SymbolNode, Unit, children

_MOST_PARTS: Final = 16
_LARGEST_FACTOR: Final = 1.0


def check_product(source: str, left: Node, right: Node) -> None:
    """Raise UnreadableError if a product without a sign is more likely to be two values."""
    kind = type(right)
    if kind is SymbolNode or kind is Call:
        return
    in_brackets = source[right.start] in "([{" and source[right.end - 1] in ")]}"
    is_whole = in_brackets and not source[: left.start].strip() and not source[right.end :].strip()
    if not (is_whole or kind is Unit or kind is Pi) or not _is_constant(right):
        return
    if _is_name(left):
        in_words = not source[right.start - 1].strip()
        if not is_whole or not (in_words or _is_angle(left) or _is_decimal(right)):
            return
        instead = left if in_words and (_is_zero(right) or not _is_angle(left)) else None
    elif _is_constant(left) and _are_values(left, right, is_whole=is_whole):
        instead = (right if type(left) is Number else left) if is_whole else None
    else:
        return
    span = left.start, right.end
    raise UnreadableError("values", span, number=False, instead=instead and _text(source, instead))


def _is_name(node: Node) -> bool:
    inside = node.operand if type(node) is Negation else node
    return type(inside) is SymbolNode and inside.symbol.kind != "number"


def _is_angle(name: Node) -> bool:
    inside = name.operand if type(name) is Negation else name
    return type(inside) is SymbolNode and inside.symbol.kind == "angle"


def _is_zero(value: Node) -> bool:
    return all(type(part) is not Number or not part.value for part in _parts(value))


def _is_decimal(value: Node) -> bool:
    inside = value.operand if type(value) is Negation else value
    return type(inside) is Number and "." in inside.literal


def _are_values(left: Node, right: Node, *, is_whole: bool) -> bool:
    of_left, of_right = _parts(left), _parts(right)
    if 180.0 in {part.value for part in (*of_left, *of_right) if type(part) is Number}:
        return False
    units = [any(type(part) is Unit for part in parts) for parts in (of_left, of_right)]
    angles = [any(type(part) in {Unit, Pi} for part in parts) for parts in (of_left, of_right)]
    if all(angles):
        return any(units) or is_whole
    number = left if angles[1] else right
    inside = number.operand if type(number) is Negation else number
    return is_whole and any(angles) and type(inside) is Number and _is_value(inside)


def _is_value(number: Number) -> bool:
    return number.value > _LARGEST_FACTOR and ("." in number.literal or number.value >= 30)


def _text(source: str, node: Node) -> str:
    text = source[node.start : node.end]
    return text[1:-1] if text[0] in "([{" and text[-1] in ")]}" else text


def _is_constant(node: Node) -> bool:
    parts = _parts(node)
    return len(parts) <= _MOST_PARTS and not any(type(part) is SymbolNode for part in parts)


def _parts(node: Node) -> list[Node]:
    found = [node]
    for part in found:
        if len(found) > _MOST_PARTS:
            break
        found += children(part)
    return found
