"""Add the unit of degrees to bare numbers in a tree, for a student who works in degrees.

An angle context is the argument of sin, cos or tan, or a whole entry that is an angle. In an angle
context, a constant term is in degrees unless it contains π, a unit or an inverse function; joint
variables and angle symbols are in radians. ``cos(q1 + 90)`` becomes ``cos(q1 + 90deg)``.

The argument of sind, cosd or tand is an angle context for every student; these functions become
sin, cos and tan.
"""

from typing import NamedTuple

from service.expressions.errors import Note
from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Pi,
    SymbolNode,
    Unit,
    children,
)
from service.expressions.vocabulary.functions import INVERSE, OF_DEGREES, TRIGONOMETRIC
from service.translations import say


class _Facts(NamedTuple):
    # Facts about a node of a formula.
    # ``constant``: the node has no symbol. ``angle``: it is an angle in radians. ``pi``: it is an
    # angle in radians because it contains π.
    constant: bool
    angle: bool
    pi: bool


def in_degrees(tree: Node, *, is_angle: bool, notes: list[Note]) -> Node:
    """Return ``tree`` with the unit of degrees on bare constants that are angles.

    ``is_angle`` is True if the whole entry is an angle. Constants written with π stay in radians.
    """
    conversion = _Conversion(tree, notes, TRIGONOMETRIC)
    return conversion.angle(tree) if is_angle else conversion.plain(tree)


def without_degree_functions(tree: Node, *, notes: list[Note]) -> Node:
    """Return ``tree`` with cosd(60) replaced by cos(60deg), for a student who works in radians."""
    return _Conversion(tree, notes, frozenset()).plain(tree)


class _Conversion:
    def __init__(self, tree: Node, notes: list[Note], functions: frozenset[str]) -> None:
        self.notes = notes
        self.functions = functions
        self.facts: dict[int, _Facts] = {}
        self._survey(tree)

    def _survey(self, node: Node) -> _Facts:
        below = [self._survey(child) for child in children(node)]
        facts = self.facts[id(node)] = _facts(node, below)
        return facts

    def plain(self, node: Node) -> Node:
        """Add the unit of degrees to the angles inside ``node``, which is not an angle itself."""
        match node:
            case Binary(operator, left, right):
                return Binary(operator, self.plain(left), self.plain(right), node.start, node.end)
            case Negation(operand):
                return Negation(self.plain(operand), node.start, node.end)
            case Unit(operand, unit):
                return Unit(self.plain(operand), unit, node.start, node.end)
            case Call(function, arguments):
                takes_degrees = function in self.functions or function in OF_DEGREES
                inside = self.angle if takes_degrees else self.plain
                name = OF_DEGREES.get(function, function)
                return Call(name, tuple(map(inside, arguments)), node.start, node.end)
            case _:
                return node

    def angle(self, node: Node) -> Node:
        """Add the unit of degrees to the bare constants in ``node``, which is an angle."""
        match node:
            case Negation(operand):
                return Negation(self.angle(operand), node.start, node.end)
            case Binary("+" | "-" as operator, left, right):
                return Binary(operator, self.angle(left), self.angle(right), node.start, node.end)
            case Call("abs", (argument,)):
                return Call("abs", (self.angle(argument),), node.start, node.end)
        if self.facts[id(node)].constant:
            return self._constant(node)
        match node:
            case Binary("*", left, right):
                return self._product(node, left, right)
            case Binary("/", left, right):
                return Binary("/", self.angle(left), self.plain(right), node.start, node.end)
            case _:
                return self.plain(node)

    def _constant(self, node: Node) -> Node:
        facts = self.facts[id(node)]
        if facts.pi:
            message = say(
                "This is written with π, so it was taken as radians although angles are in "
                "degrees here."
            )
            self.notes.append(Note("radians_in_degrees", message, (node.start, node.end)))
        if facts.angle or (type(node) is Number and node.value == 0):
            return self.plain(node)
        return Unit(self.plain(node), "deg", node.start, node.end)

    def _product(self, node: Node, left: Node, right: Node) -> Node:
        # Add degrees in the one factor that is an angle: q1 + 45 in 2*(q1 + 45), or 90 in k*90.
        one, other = self.facts[id(left)], self.facts[id(right)]
        angles = one.angle, other.angle
        if angles == (False, False):
            angles = (False, True) if other.constant else (one.constant, False)
        first = self.angle(left) if angles == (True, False) else self.plain(left)
        second = self.angle(right) if angles == (False, True) else self.plain(right)
        return Binary("*", first, second, node.start, node.end)


def _facts(node: Node, below: list[_Facts]) -> _Facts:
    constant = all(facts.constant for facts in below)
    angle = any(facts.angle for facts in below)
    pi = any(facts.pi for facts in below)
    match node:
        case Pi():
            return _Facts(constant, True, True)
        case Unit():
            return _Facts(constant, True, False)
        case SymbolNode(symbol):
            return _Facts(False, symbol.kind == "angle", False)
        case Call("abs"):
            return _Facts(constant, angle, pi)
        case Call(function):
            # A sine is not an angle, even if its argument is one.
            return _Facts(constant, function in INVERSE, False)
        case _:
            return _Facts(constant, angle, pi)
