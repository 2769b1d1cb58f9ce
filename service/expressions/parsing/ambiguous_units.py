"""Refuse ambiguous degree signs: π/2° may mean π/2 or 90°."""

from typing import Final

from service.expressions.errors import Span, UnreadableError
from service.expressions.tree import Node, Number, Pi, Unit, children

# With one of these numbers, π belongs to a conversion, as in (q*180/π)°.
_HALF_TURNS: Final = frozenset({180.0, 360.0})
_MOST_PARTS: Final = 64


def check_unit(operand: Node, span: Span) -> None:
    """Raise UnreadableError if ``operand``, which has a degree sign, contains π."""
    if _is_of_pi(operand):
        inside = (operand.start, operand.end)
        raise UnreadableError("ambiguous_unit", span, opens=False, of_pi=True, inside=inside)


def check_divisor(left: Node, right: Unit) -> None:
    """Raise UnreadableError for a quotient in which only the divisor is in degrees: 180/2°."""
    inside = right.operand
    # The unit of deg2rad(2) belongs to the divisor.
    if right.unit != "deg" or inside.start != right.start or _has(left, Unit):
        return
    raise UnreadableError(
        "ambiguous_unit",
        (left.start, right.end),
        opens=False,
        of_pi=_is_of_pi(left),
        inside=(left.start, inside.end),
    )


def _is_of_pi(node: Node) -> bool:
    return _has(node, Pi) and not any(
        type(part) is Number and part.value in _HALF_TURNS for part in _parts(node)
    )


def _has(node: Node, kind: type[Node]) -> bool:
    return any(type(part) is kind for part in _parts(node))


def _parts(node: Node) -> list[Node]:
    found = [node]
    for part in found:
        if len(found) > _MOST_PARTS:
            break
        found += children(part)
    return found
