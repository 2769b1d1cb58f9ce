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
from service.expressions.functions import INVERSE, TRIGONOMETRIC
from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Pi,
    Unit,
    Variable,
    children,
)
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
                text = f"{value:.12g}" if _is_number(term) else f"({constant.text()})"
                yield warning(
                    field, f"{text} has no unit and is read in radians; did you mean {text}deg?"
                )


def _bare_terms(node: Node, *, is_angle: bool) -> Iterator[Node]:
    """The constant terms without a unit in the sums of angles that a tree holds."""
    if is_angle and _is_bare(node):
        yield node
        return
    is_sum = isinstance(node, Negation) or (isinstance(node, Binary) and node.operator in "+-")
    for child in children(node):
        match node:
            case Unit():
                return
            case Call(function):
                below = function in TRIGONOMETRIC
            case _:
                # A constant factor is no angle: 10*k.
                below = is_angle and (is_sum or not _is_bare(child))
        yield from _bare_terms(child, is_angle=below)


def _is_bare(node: Node) -> bool:
    """Whether a tree is a constant that nothing in it makes an angle."""
    match node:
        case Variable() | Pi() | Unit():
            return False
        case Call(function) if function in INVERSE:
            return False
        case _:
            return all(map(_is_bare, children(node)))


def _is_number(node: Node) -> bool:
    return isinstance(node.operand if isinstance(node, Negation) else node, Number)


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
