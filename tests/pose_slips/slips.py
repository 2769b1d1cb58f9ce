"""Single slips of a table: sign, zero, quarter turn, wrong index, standing still, the wrong way."""

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp

from tests.pose_slips.robots import SpoiltRobot

A, ALPHA, D, THETA = range(4)


@dataclass(frozen=True)
class TableSlip:
    """A cell that is wrong: its row and column, what stands in it, and the codes of the slip.

    ``joint`` is the number of the row's joint or the last, ``label`` that of the row.
    """

    row: int
    column: int
    cell: sp.Expr
    codes: frozenset[str]
    joint: int
    label: str


def slips_of(robot: SpoiltRobot) -> Iterator[TableSlip]:
    """All single slips of a robot's table."""
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
