"""Angles that were intended in degrees: a bare number in a file is in radians."""

import math
from collections.abc import Iterator
from typing import Final

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise
from service.expressions import Expression
from service.expressions.parsing.degrees import in_degrees
from service.expressions.tree import Node, Number, Unit, children

# Nobody writes more than a full turn in radians without π.
MOST: Final = 2 * math.pi


def bare_degrees(exercise: Exercise) -> Iterator[Remark]:
    """Constants without a unit of more than a full turn, where an angle is asked for."""
    for field, formula, quantity in exercise.fields():
        for term in _bare_terms(formula.tree, is_angle=quantity == "angle"):
            constant = Expression(formula.source, term, (), frozenset())
            value = float(constant.evaluate({}))
            if abs(value) > MOST:
                text = f"{value:.12g}" if isinstance(term, Number) else f"({constant.text()})"
                yield warning(
                    field, f"{text} has no unit and is read in radians; did you mean {text}deg?"
                )


def _bare_terms(tree: Node, *, is_angle: bool) -> Iterator[Node]:
    """Terms that would be in degrees if the file's numbers were, by the rule for students."""
    written = {(unit.start, unit.end) for unit in _units(tree)}
    for unit in _units(in_degrees(tree, is_angle=is_angle, notes=[])):
        if (unit.start, unit.end) not in written:
            yield unit.operand


def _units(node: Node) -> Iterator[Unit]:
    if isinstance(node, Unit):
        yield node
    for child in children(node):
        yield from _units(child)
