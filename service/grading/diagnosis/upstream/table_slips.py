"""Slips in the cells of the robot's table that lead to a wrong pose."""

# A slip has the same code here as in a submitted table (table_cell).

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
)
from service.grading.diagnosis.upstream.length_slips import length_slips
from service.grading.diagnosis.upstream.slip import CellChange, Names, Slip, SlipWords
from service.grading.diagnosis.upstream.slip_kinds import (
    ANGLE_LEFT_OUT,
    DISTANCE_LEFT_OUT,
    HALF_TURN,
    QUARTER_TURN,
    SIGN,
)
from service.grading.diagnosis.wording import AXES, SYMBOLS, axes_of_row
from service.grading.misconception import Record
from service.grading.numerics.tolerances import CONSTANT
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import ALPHA, THETA, A, D, Table
from service.kinematics.dh import Convention
from service.translations import Sentence, paragraph, say

QUARTER = np.pi / 2


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table, and the words about it in messages."""

    table: ReferenceTable
    row: int
    column: int
    # True if the student chose other frames: the correct value of the cell may differ from table.
    own_frames: bool

    @property
    def label(self) -> str:
        """The label of the cell's row."""
        return self.table.labels[self.row]

    @property
    def axes(self) -> str:
        """The two axes between which the cell's angle is measured."""
        axis = "z" if self.column == ALPHA else "x"
        return axes_of_row(axis, self.label, self.table.joints[-1].index)

    @property
    def correction(self) -> str:
        """A sentence with the correct formula, or "" if the formula is unknown."""
        if self.own_frames:
            return ""
        return say(
            "{symbol} in row {row} is {formula}.",
            symbol=SYMBOLS[self.column],
            row=self.label,
            formula=self.table.rows[self.row][self.column].text(),
        )

    @property
    def parameter(self) -> Sentence:
        """The parameter in words, such as "the offset along the axis of joint 2"."""
        return _parameter(self.table, self.row, self.column)

    def name(self, names: Names) -> str:
        """Return the student's name for the cell's only constant, or a, α, d or θ."""
        letters = _letters(self.table, self.row, self.column)
        if len(letters) == 1 and not self.own_frames:
            return names.shown(min(letters)) or SYMBOLS[self.column]
        return SYMBOLS[self.column]


def table_slips(
    table: ReferenceTable,
    constants: Table,
    axis: Axis,
    *,
    home: bool = False,
    whole: bool = True,
) -> Iterator[Slip]:
    """Yield all slips in a table.

    ``constants`` ``(rows, 4, samples)`` is the table with all joint variables 0.
    """
    # With home, the answer is for the home position, so that only constants can be wrong. With
    # whole, slips of whole rows and columns are tried, too.
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
    """Return all lengths of the table, and the lengths that occur only once, alone in a cell."""
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
    """Yield the slips in one row.

    ``constants`` are the cells of the row at one sample, with all joint variables 0.
    """
    # With own_frames, the student chose other frames, so that constants differ from table. With
    # home, the answer is for the home position, so that no joint moves.
    joint = table.joints[row] if row < len(table.joints) and not home else None
    for column in (A, ALPHA, D, THETA):
        cell, constant = Cell(table, row, column, own_frames), constants[column]
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
        yield _turned(cell, QUARTER_TURN, QUARTER)
        yield _turned(cell, QUARTER_TURN, -QUARTER)
        if not is_quarter:
            yield _turned(cell, HALF_TURN, np.pi)


def _sign(cell: Cell) -> Slip:
    def words(names: Names) -> SlipWords:
        name, axis = cell.name(names), AXES[cell.column]
        clause = say("{name}, {parameter}, has the wrong sign", name=name, parameter=cell.parameter)
        hint = say(
            "{name}, {parameter}, has the wrong sign: it is measured along {axis}, positive in the "
            "direction of the axis.",
            name=name,
            parameter=cell.parameter,
            axis=axis,
        )
        if IS_ANGLE[cell.column]:
            hint = say(
                "{name}, {parameter}, has the wrong sign: it is measured about {axis}, positive by "
                "the right-hand rule.",
                name=name,
                parameter=cell.parameter,
                axis=axis,
            )
        return SlipWords(clause, hint, cell.correction)

    return Slip(SIGN, words, cells=(CellChange(cell.row, cell.column, -1.0),))


def _left_out(cell: Cell, kind: Record) -> Slip:
    def words(names: Names) -> SlipWords:
        name = cell.name(names)
        clause = say("{name}, {parameter}, is left out", name=name, parameter=cell.parameter)
        hint = say(
            "{name}, {parameter}, is left out: check {link}.",
            name=name,
            parameter=cell.parameter,
            link=f"A{cell.label}",
        )
        return SlipWords(clause, hint, cell.correction)

    return Slip(kind, words, cells=(CellChange(cell.row, cell.column, 0.0),))


def _turned(cell: Cell, kind: Record, turn: float) -> Slip:
    def words(names: Names) -> SlipWords:
        name = cell.name(names)
        clause = say("{name}, {parameter}, is not right", name=name, parameter=cell.parameter)
        hint = say(
            "{name}, {parameter}, is not right: compare {axes} in the home position.",
            name=name,
            parameter=cell.parameter,
            axes=cell.axes,
        )
        error = say("It is off by a quarter turn (90°).")
        if kind is HALF_TURN:
            error = say("It is off by half a turn (180°).")
        return SlipWords(clause, hint, paragraph(cell.correction, error))

    return Slip(kind, words, cells=(CellChange(cell.row, cell.column, 1.0, turn),))


def _letters(table: ReferenceTable, row: int, column: int) -> frozenset[str]:
    variables = {joint.variable for joint in table.joints}
    return table.rows[row][column].symbols - variables


def _parameter(table: ReferenceTable, row: int, column: int) -> Sentence:
    joints = [joint.index for joint in table.joints]
    if row < len(joints) and column == D:
        return say("the offset along the axis of joint {joint}", joint=joints[row])
    if row < len(joints) and column == THETA:
        return say("the angle about the axis of joint {joint}", joint=joints[row])
    # The number of joints before the x axis along which a and α are measured.
    before = row + (table.convention is Convention.STANDARD)
    if column in (D, THETA) or before > len(joints):
        return say("the parameter in row {row}", row=table.labels[row])
    return _length(joints, before) if column == A else _twist(joints, before)


def _length(joints: Sequence[int], before: int) -> Sentence:
    if before == 0:
        return say(
            "the length between {axis} and the axis of joint {joint}",
            axis=f"z{joints[0] - 1}",
            joint=joints[0],
        )
    if before == len(joints):
        return say(
            "the length between the axis of joint {joint} and the last z axis", joint=joints[-1]
        )
    return say(
        "the length between the axes of joints {joint} and {next}",
        joint=joints[before - 1],
        next=joints[before],
    )


def _twist(joints: Sequence[int], before: int) -> Sentence:
    if before == 0:
        return say(
            "the twist between {axis} and the axis of joint {joint}",
            axis=f"z{joints[0] - 1}",
            joint=joints[0],
        )
    if before == len(joints):
        return say(
            "the twist between the axis of joint {joint} and the last z axis", joint=joints[-1]
        )
    return say(
        "the twist between the axes of joints {joint} and {next}",
        joint=joints[before - 1],
        next=joints[before],
    )
