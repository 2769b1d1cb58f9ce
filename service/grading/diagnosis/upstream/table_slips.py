"""Slips in the cells of the robot's table that lead to a wrong pose.

They have the codes of the same slips in a submitted table (``table_cell``).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from service.catalogue import ReferenceTable
from service.grading.diagnosis.tables.rows_and_columns import (
    TableRows,
    exchanged_in_row,
    slips_of_rows,
)
from service.grading.diagnosis.upstream.joint_slips import (
    Axis,
    home_slip,
    joint_slips,
    joint_variable_missing,
    joint_variable_sign,
    length_slips,
)
from service.grading.diagnosis.upstream.slip import CellChange, Slip
from service.grading.diagnosis.upstream.slip_kinds import (
    ANGLE_LEFT_OUT,
    DISTANCE_LEFT_OUT,
    HALF_TURN,
    QUARTER_TURN,
    SIGN,
)
from service.grading.diagnosis.wording import MEASURED, POSITIVE, SYMBOLS, axes_of_row
from service.grading.misconception import Record
from service.grading.numerics.tolerances import CONSTANT
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import ALPHA, THETA, A, D, Table
from service.kinematics.dh import Convention

QUARTER = np.pi / 2
NOUNS = ("length", "twist", "offset", "angle")


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table: its place, and in words its parameter, its link and the right formula.

    ``axes`` are the two axes that an angle lies between.
    """

    row: int
    column: int
    parameter: str
    link: str
    axes: str
    correction: str = ""


def table_slips(
    table: ReferenceTable,
    constants: Table,
    axis: Axis,
    *,
    home: bool = False,
    whole: bool = True,
) -> Iterator[Slip]:
    """Yield all single slips; ``constants`` ``(rows, 4, samples)`` is the table at home.

    If the answer is for the ``home`` position, only constants can be wrong. Slips of whole rows and
    columns are tried only if the answer follows from the ``whole`` table.
    """
    if not home:
        yield from joint_slips(table.joints, table.joints, axis)
        yield from home_slip(table.joints)
    for i in range(len(table.rows)):
        yield from row_slips(table, i, constants[i, :, 0].tolist(), axis, home=home)
    yield from length_slips(*lengths_of(table))
    if whole:
        rows = TableRows(constants[..., 0], table.joints, table.labels, table.convention, home)
        yield from slips_of_rows(rows)


def lengths_of(table: ReferenceTable) -> tuple[list[str], list[str]]:
    """Return the lengths of the table in order, and those that are alone in their only cell."""
    cells = [_letters(table, i, column) for i in range(len(table.rows)) for column in (A, D)]
    names = list(dict.fromkeys(name for cell in cells for name in sorted(cell)))
    once = [name for name in names if sum(name in cell for cell in cells) == 1]
    return names, [name for name in once if {name} in cells]


def row_slips(
    table: ReferenceTable,
    row: int,
    constants: Sequence[float],
    axis: Axis,
    *,
    own_frames: bool = False,
    home: bool = False,
) -> Iterator[Slip]:
    """Yield the slips in the ``constants`` of one row: its cells at home, at one sample.

    With ``own_frames``, the cells are not those of the table. At ``home`` no joint moves.
    """
    joint = table.joints[row] if row < len(table.joints) and not home else None
    for column in (A, ALPHA, D, THETA):
        cell, constant = _cell(table, row, column, own_frames=own_frames), constants[column]
        moves = joint is not None and column == (D if joint.prismatic else THETA)
        if IS_ANGLE[column]:
            yield from _angle_slips(cell, constant, moves=moves)
        elif abs(constant) > CONSTANT:
            yield _sign(cell)
            yield _left_out(cell, DISTANCE_LEFT_OUT)
        if moves and joint is not None and abs(constant) > CONSTANT:
            yield joint_variable_sign(joint, axis, CellChange(row, column, -1.0))
            yield joint_variable_missing(joint, CellChange(row, column, 0.0))
    slides = joint is not None and joint.prismatic
    yield from exchanged_in_row(row, table.labels[row], constants, slides=slides)


def _angle_slips(cell: Cell, constant: float, *, moves: bool) -> Iterator[Slip]:
    quarters = constant / QUARTER
    is_multiple = abs(quarters - round(quarters)) < CONSTANT
    is_quarter = is_multiple and round(quarters) % 2 == 1
    if is_quarter or not is_multiple:
        yield _sign(cell)
    if not is_multiple:
        yield _left_out(cell, ANGLE_LEFT_OUT)
    # For a joint's angle, ``joint_slips`` has these slips.
    if not moves:
        yield _turned(cell, QUARTER_TURN, QUARTER, "a quarter turn (90°)")
        yield _turned(cell, QUARTER_TURN, -QUARTER, "a quarter turn (90°)")
        if not is_quarter:
            yield _turned(cell, HALF_TURN, np.pi, "half a turn (180°)")


def _sign(cell: Cell) -> Slip:
    column = cell.column
    return Slip(
        SIGN,
        f"{cell.parameter} has the wrong sign",
        f"it is measured {MEASURED[column]}, positive {POSITIVE[column]}.",
        cell.correction,
        cells=(CellChange(cell.row, column, -1.0),),
    )


def _left_out(cell: Cell, kind: Record) -> Slip:
    return Slip(
        kind,
        f"{cell.parameter} is left out",
        f"check {cell.link}.",
        cell.correction,
        cells=(CellChange(cell.row, cell.column, 0.0),),
    )


def _turned(cell: Cell, kind: Record, turn: float, error: str) -> Slip:
    return Slip(
        kind,
        f"{cell.parameter} is not right",
        f"compare {cell.axes} in the home position.",
        f"{cell.correction} It is off by {error}.".strip(),
        cells=(CellChange(cell.row, cell.column, 1.0, turn),),
    )


def _cell(table: ReferenceTable, row: int, column: int, *, own_frames: bool) -> Cell:
    symbol, label = SYMBOLS[column], table.labels[row]
    letters = _letters(table, row, column)
    letter = f"{{{min(letters)}:{symbol}}}" if len(letters) == 1 and not own_frames else symbol
    right = f"{symbol} in row {label} is {table.rows[row][column].text()}."
    parameter = f"the {NOUNS[column]} {letter} {_place(table, row, column)}"
    axes = axes_of_row("z" if column == ALPHA else "x", label, table.joints[-1].index)
    return Cell(row, column, parameter, f"A{label}", axes, "" if own_frames else right)


def _letters(table: ReferenceTable, row: int, column: int) -> frozenset[str]:
    """Return the symbols of a cell except the joint variable."""
    variables = {joint.variable for joint in table.joints}
    return table.rows[row][column].symbols - variables


def _place(table: ReferenceTable, row: int, column: int) -> str:
    joints = [joint.index for joint in table.joints]
    along = MEASURED[column].split()[0]
    if column in (D, THETA) and row < len(joints):
        return f"{along} the axis of joint {joints[row]}"
    # The number of joints before the x axis along which a and α are measured.
    before = row + (table.convention is Convention.STANDARD)
    if column in (D, THETA) or before > len(joints):
        return f"{MEASURED[column]} in row {table.labels[row]}"
    if before == 0:
        return f"between z{joints[0] - 1} and the axis of joint {joints[0]}"
    if before == len(joints):
        return f"between the axis of joint {joints[-1]} and the last z axis"
    return f"between the axes of joints {joints[before - 1]} and {joints[before]}"
