"""The syntax tree of an expression.

    Number 90 | Pi | SymbolNode theta1
    Unit deg ─ operand            90deg, 90°, deg(90)
    Negation ─ operand            -q1
    Binary + ┬ left               q1 + q2, l1*c1, 1/2, x^2
             └ right
    Call cos ─ arguments          cos(q1), c1, atan2(y, x)

The tree does not store brackets, spelling or the c12 shorthand, so formulas that differ only in
these have equal trees. ``start`` and ``end`` are offsets in the text as typed, and are ignored by
equality. Do not change a finished tree.
"""

from dataclasses import dataclass, field
from typing import Literal

from dh_grader.expressions.vocabulary import Symbol

# The classes are not frozen, because a frozen dataclass takes four times as long to construct.


UnitName = Literal["deg", "rad"]
Operator = Literal["+", "-", "*", "/", "^"]


@dataclass(slots=True)
class Number:
    """A numeric constant, never negative; ``literal`` is its text."""

    value: float
    literal: str = field(compare=False)
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Pi:
    """The constant π."""

    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class SymbolNode:
    """A declared symbol."""

    symbol: Symbol
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Unit:
    """An operand with an explicit angle unit."""

    operand: "Node"
    unit: UnitName
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Negation:
    """A minus sign and its operand."""

    operand: "Node"
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Binary:
    """Two operands joined by an operator."""

    operator: Operator
    left: "Node"
    right: "Node"
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Call:
    """A function call."""

    function: str
    arguments: tuple["Node", ...]
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


Node = Number | Pi | SymbolNode | Unit | Negation | Binary | Call


def children(node: Node) -> tuple[Node, ...]:
    """Return the operands or arguments of ``node``, from left to right."""
    kind = type(node)
    if kind is Binary:
        return (node.left, node.right)  # type: ignore[union-attr]
    if kind is Call:
        return node.arguments  # type: ignore[union-attr]
    if kind is Negation or kind is Unit:
        return (node.operand,)  # type: ignore[union-attr]
    return ()
