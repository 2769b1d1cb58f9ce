"""Generate slips of a table: in one cell, or in whole rows and columns."""

# In a cell: wrong sign, zero, quarter turn, wrong index, missing or negated joint variable.

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import sympy as sp

from tests.pose_slips.robots import SpoiltRobot

A, ALPHA, D, THETA = range(4)


@dataclass(frozen=True)
class TableSlip:
    """A slip in one cell, or a whole wrong table."""

    # A message with one of `codes` names the slip. `joint` is the number of the row's joint; for a
    # fixed row, it is the number of the last joint. `label` is the label of the row.
    row: int
    column: int
    cell: sp.Expr
    codes: frozenset[str]
    joint: int
    label: str
    rows: tuple[tuple[sp.Expr, ...], ...] = ()


def slips_of(robot: SpoiltRobot) -> Iterator[TableSlip]:
    """Yield all single slips of a robot's table."""
    yield from _of_cells(robot)
    for codes, rows in _of_rows(robot):
        yield TableSlip(0, 0, sp.Integer(0), frozenset(codes.split()), 0, "", rows)


def _of_rows(robot: SpoiltRobot) -> Iterator[tuple[str, tuple[tuple[sp.Expr, ...], ...]]]:
    # Yield whole wrong tables, each with the codes of its slip.
    #
    # In a wrong table, a and d are exchanged in a row, two rows are exchanged, all α are negated,
    # or the rows are those of the other convention.
    rows, none = robot.rows, (sp.Integer(0), sp.Integer(0))
    for i, ((a, alpha, d, theta), joint) in enumerate(zip(rows, robot.joints, strict=True)):
        moving = joint[1] if joint and d.has(joint[1]) else 0
        swapped = (d - moving, alpha, a + moving, theta)
        yield "columns_swapped", (*rows[:i], swapped, *rows[i + 1 :])
    negated = tuple((a, -alpha, d, theta) for a, alpha, d, theta in rows)
    yield "parameter_sign sign row_sign column_sign", negated
    links = [row[:2] for row in rows]
    if robot.convention == "standard" or not any(links[0]):
        is_standard = robot.convention == "standard"
        moved = [none, *links[:-1]] if is_standard else [*links[1:], none]
        other = [(*link, *row[2:]) for link, row in zip(moved, rows, strict=True)]
        if is_standard and any(links[-1]):
            other.append((*links[-1], *none))
        yield "other_convention", tuple(other)
    for i, j in combinations(range(len(rows)), 2):
        exchanged = list(rows)
        exchanged[i], exchanged[j] = rows[j], rows[i]
        yield "row_order reversed_product", tuple(exchanged)


def _of_cells(robot: SpoiltRobot) -> Iterator[TableSlip]:
    numbers = [joint[0] for joint in robot.joints if joint]
    for i, (row, joint) in enumerate(zip(robot.rows, robot.joints, strict=True)):
        number, label = (joint[0], str(joint[0])) if joint else (numbers[-1], "e")
        for column, cell in enumerate(row):
            moves = joint is not None and cell.has(joint[1])
            cells = _moving(cell, joint, robot) if moves else _constant(cell, column)
            for code, wrong in cells:
                if sp.simplify(wrong - cell) != 0:
                    yield TableSlip(i, column, wrong, frozenset(code.split()), number, label)


def _constant(cell: sp.Expr, column: int) -> Iterator[tuple[str, sp.Expr]]:
    if column in (A, D):
        yield "sign", -cell
        yield "distance_left_out", sp.Integer(0)
        return
    if sp.sin(cell) != 0:
        yield "sign", -cell
    for turn in (sp.pi / 2, -sp.pi / 2):
        if not (sp.sin(cell) != 0 and sp.cos(cell) == 0 and sp.sin(cell + turn) == 0):
            yield "quarter_turn", cell + turn
    yield ("quarter_turn half_turn angle_left_out"), sp.Integer(0)


def _moving(
    cell: sp.Expr, joint: tuple[int, sp.Symbol, bool] | None, robot: SpoiltRobot
) -> Iterator[tuple[str, sp.Expr]]:
    assert joint is not None
    _, variable, slides = joint
    yield "joint_variable_sign", cell.subs(variable, -variable)
    yield "joint_variable_missing", cell.subs(variable, 0)
    for other in robot.joints:
        if other and other[1] != variable and other[2] == slides:
            yield "joint_variable_index", cell.subs(variable, other[1])
    constant = cell.subs(variable, 0)
    if constant != 0:
        yield "sign", variable - constant
        yield "distance_left_out angle_left_out quarter_turn half_turn", variable
    if not slides:
        yield "quarter_turn", cell + sp.pi / 2
        yield "quarter_turn", cell - sp.pi / 2
