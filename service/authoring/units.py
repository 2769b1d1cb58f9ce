"""Angles that were meant in degrees: a bare number in a file is in radians."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise, FormulaGrid, PartSpec, Robot, ScrewRobot
from service.catalogue.schema import (
    DhRowSpec,
    EulerAnglesSpec,
    MatrixSpec,
    PositionSpec,
    RotationSpec,
    VectorSpec,
)
from service.expressions import Expression
from service.expressions.parsing.degrees import in_degrees
from service.expressions.tree import Node, Number, Unit, children
from service.kinematics.chain import COLUMNS

# Nobody writes more than a full turn in radians without π.
MOST: Final = 2 * math.pi
_ANGLES: Final = {"alpha", "theta"}

# Where a formula stands in the file, and whether its value is an angle.
_Place = tuple[str, Expression, bool]


def bare_degrees(exercise: Exercise) -> Iterator[Remark]:
    """Constants without a unit of more than a full turn, where an angle is asked for."""
    for field, formula, is_angle in _formulas(exercise):
        for term in _bare_terms(formula.tree, is_angle=is_angle):
            constant = Expression(formula.source, term, (), frozenset())
            value = float(constant.evaluate({}))
            if abs(value) > MOST:
                text = f"{value:.12g}" if isinstance(term, Number) else f"({constant.text()})"
                yield warning(
                    field, f"{text} has no unit and is read in radians; did you mean {text}deg?"
                )


def _bare_terms(tree: Node, *, is_angle: bool) -> Iterator[Node]:
    """What would be in degrees if the file's numbers were: the rule that students are read by."""
    written = {(unit.start, unit.end) for unit in _units(tree)}
    for unit in _units(in_degrees(tree, is_angle=is_angle, notes=[])):
        if (unit.start, unit.end) not in written:
            yield unit.operand


def _units(node: Node) -> Iterator[Unit]:
    if isinstance(node, Unit):
        yield node
    for child in children(node):
        yield from _units(child)


def _formulas(exercise: Exercise) -> Iterator[_Place]:
    match exercise.reference:
        case Robot(tables=tables, convention=convention):
            for i, row in enumerate(tables[convention].rows):
                for column, cell in zip(COLUMNS, row, strict=True):
                    yield f"robot.table[{i}].{column}", cell, column in _ANGLES
        case ScrewRobot(home=home, axes=axes):
            yield from _of_matrix("robot.home", home)
            yield from _of_matrix("robot.screws", axes)
        case None:
            pass
    for i, part in enumerate(exercise.parts):
        if part.id in exercise.formulas:
            yield from _of_part(f"parts[{i}]", part, exercise.formulas[part.id])


def _of_part(field: str, part: PartSpec, grid: FormulaGrid) -> Iterator[_Place]:
    match part:
        case RotationSpec(steps=[*_]):
            yield from _of_list(f"{field}.steps", grid, [True] * len(grid[0]), ".angle")
        case VectorSpec(components=components):
            angles = [component.quantity == "angle" for component in components]
            yield from _of_list(f"{field}.components", grid, angles, ".expected")
        case EulerAnglesSpec() | PositionSpec():
            angles = [isinstance(part, EulerAnglesSpec)] * len(grid[0])
            yield from _of_list(f"{field}.expected", grid, angles)
        case MatrixSpec(quantities=quantities):
            # All rows hold the same quantities.
            angles = [quantity == "angle" for quantity in quantities[0]]
            yield from _of_matrix(f"{field}.expected", grid, angles)
        case DhRowSpec():
            yield from _of_matrix(f"{field}.transform", grid)
        case _:
            yield from _of_matrix(f"{field}.expected", grid)


def _of_list(
    field: str, grid: FormulaGrid, angles: Sequence[bool], below: str = ""
) -> Iterator[_Place]:
    for j, (entry, is_angle) in enumerate(zip(grid[0], angles, strict=True)):
        yield f"{field}[{j}]{below}", entry, is_angle


def _of_matrix(field: str, grid: FormulaGrid, angles: Sequence[bool] = ()) -> Iterator[_Place]:
    """The entries row by row; ``angles`` says which columns hold angles, without it none."""
    for i, row in enumerate(grid):
        yield from _of_list(f"{field}[{i}]", (row,), angles or [False] * len(row))
