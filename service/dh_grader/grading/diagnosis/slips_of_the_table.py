"""Slips in lengths, joints and cells of the robot's table that lead to a wrong pose.

``upstream.py`` searches among them; ``whole_tables.py`` has those of rows and columns.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations

import numpy as np

from dh_grader.catalogue import Exercise, Joint, ReferenceTable
from dh_grader.grading.diagnosis.whole_tables import (
    ANGLE_LEFT_OUT,
    DISTANCE_LEFT_OUT,
    HALF_TURN,
    HOME_POSITION,
    JOINT_VARIABLE_DOUBLED,
    JOINT_VARIABLE_INDEX,
    JOINT_VARIABLE_MISSING,
    JOINT_VARIABLE_SIGN,
    LENGTHS_EXCHANGED,
    OTHER_LENGTH,
    QUARTER_TURN,
    SIGN,
    CellChange,
    Names,
    Slip,
    SlipWords,
    SymbolChange,
    TableRows,
    exchanged_in_row,
    slips_of_rows,
)
from dh_grader.grading.misconception import AXES, SYMBOLS, Record, axes_of_row
from dh_grader.grading.numbers import CONSTANT, SAME_MOTION, Samples
from dh_grader.grading.reading.table import IS_ANGLE
from dh_grader.kinematics import ALPHA, THETA, A, Convention, D, Numbers, Table
from dh_grader.translations import Sentence, paragraph, say

# --- Slips in the lengths of an answer, such as a wrong sign


# Robots have a handful of lengths. With more, pairs are not tried.
MAX_LENGTHS = 12


def length_slips(lengths: Sequence[str], alone: Iterable[str] = ()) -> Iterator[Slip]:
    """Yield the slips in these lengths: wrong signs, missing lengths and exchanged lengths."""
    # For the lengths alone, each of which is a whole cell of the table, only exchanges are yielded.
    in_cells = set(alone)
    for length in lengths:
        if length not in in_cells:
            yield _length_sign(length)
            yield _length_left_out(length)
    if len(lengths) <= MAX_LENGTHS:
        for one, other in combinations(lengths, 2):
            yield _exchanged(one, other)
            yield _other_length(one, other)
            yield _other_length(other, one)


def _length_sign(length: str) -> Slip:
    def words(names: Names) -> SlipWords:
        name = names.shown(length)
        clause = say("the length of one link has the wrong sign")
        hint = say(
            "The length of one link has the wrong sign: check along which axis it is measured, and "
            "which way."
        )
        if name:
            clause = say("the length {name} has the wrong sign", name=name)
            hint = say(
                "The length {name} has the wrong sign: check along which axis it is measured, and "
                "which way.",
                name=name,
            )
        correction = say("Change the sign of {name} throughout.", name=names.name(length))
        return SlipWords(clause, hint, correction)

    return Slip(SIGN, words, symbols=(SymbolChange(length, length, -1.0),))


def _length_left_out(length: str) -> Slip:
    def words(names: Names) -> SlipWords:
        name = names.shown(length)
        clause = say("the length of one link is left out")
        hint = say("The length of one link is left out: check which frames it lies between.")
        if name:
            clause = say("the length {name} is left out", name=name)
            hint = say(
                "The length {name} is left out: check which frames it lies between.", name=name
            )
        return SlipWords(clause, hint)

    return Slip(DISTANCE_LEFT_OUT, words, symbols=(SymbolChange(length, length, 0.0),))


def _exchanged(one: str, other: str) -> Slip:
    def words(names: Names) -> SlipWords:
        first, second = names.shown(one), names.shown(other)
        clause = say("the lengths of two links are exchanged")
        hint = say(
            "The lengths of two links are exchanged: check which link each of them belongs to."
        )
        if first and second:
            clause = say("the lengths {one} and {other} are exchanged", one=first, other=second)
            hint = say(
                "The lengths {one} and {other} are exchanged: check which link each of them "
                "belongs to.",
                one=first,
                other=second,
            )
        correction = say(
            "Write {one} for {other}, and {other} for {one}.",
            one=names.name(one),
            other=names.name(other),
        )
        return SlipWords(clause, hint, correction)

    return Slip(
        LENGTHS_EXCHANGED, words, symbols=(SymbolChange(one, other), SymbolChange(other, one))
    )


def _other_length(right: str, written: str) -> Slip:
    def words(names: Names) -> SlipWords:
        name = names.shown(written)
        clause = say("the length of one link stands where another length belongs")
        hint = say(
            "The length of one link stands where another length belongs: check which link it "
            "belongs to."
        )
        if name:
            clause = say("the length {name} stands where another length belongs", name=name)
            hint = say(
                "The length {name} stands where another length belongs: check which link it "
                "belongs to.",
                name=name,
            )
        return SlipWords(clause, hint, say("It is {name}.", name=names.name(right)))

    return Slip(OTHER_LENGTH, words, symbols=(SymbolChange(right, written),))


# --- Slips in the joint variables of a robot that is given by a table or by screw axes


Axis = Callable[[Joint], Sentence]


def joint_slips(moved: Sequence[Joint], joints: Sequence[Joint], axis: Axis) -> Iterator[Slip]:
    """Yield the slips in the variables of the ``moved`` joints.

    ``joints`` are all joints. ``axis`` returns advice on the direction of a joint's axis.
    """
    for joint in moved:
        yield joint_variable_sign(joint, axis)
        yield joint_variable_missing(joint)
        similar = [each for each in joints if each.prismatic == joint.prismatic and each != joint]
        # The nearest joint first: its variable is the likeliest to be taken.
        for other in sorted(similar, key=lambda each: abs(each.index - joint.index)):
            yield _joint_variable_index(joint, other)
        yield _joint_variable_doubled(joint)
        if not joint.prismatic:
            yield from _zero_position(joint)


def joint_variable_sign(joint: Joint, axis: Axis, *cells: CellChange) -> Slip:
    """Return the slip in which a joint variable has the wrong sign."""

    def words(names: Names) -> SlipWords:
        hint = say(
            "Joint {joint} moves the wrong way: check the sign of its variable.", joint=joint.index
        )
        return SlipWords(
            say("joint {joint} moves the wrong way", joint=joint.index),
            paragraph(hint, axis(joint)),
            say("Change the sign of {name} throughout.", name=names.name(joint.variable)),
        )

    symbols = (SymbolChange(joint.variable, joint.variable, -1.0),)
    return Slip(JOINT_VARIABLE_SIGN, words, symbols=symbols, cells=cells)


def joint_variable_missing(joint: Joint, *cells: CellChange) -> Slip:
    """Return the slip in which a joint variable is missing."""

    def words(names: Names) -> SlipWords:
        index, name = joint.index, names.shown(joint.variable)
        hint = say(
            "Joint {joint} stands still: check what must change with its variable.", joint=index
        )
        if name:
            hint = say(
                "Joint {joint} stands still: check what must change with {name}.",
                joint=index,
                name=name,
            )
        correction = _moves_with(joint, names.name(joint.variable))
        return SlipWords(say("joint {joint} stands still", joint=index), hint, correction)

    symbols = (SymbolChange(joint.variable, joint.variable, 0.0),)
    return Slip(JOINT_VARIABLE_MISSING, words, symbols=symbols, cells=cells)


def _moves_with(joint: Joint, name: str) -> Sentence:
    return say("Joint {joint} moves with {name}.", joint=joint.index, name=name)


def _joint_variable_index(joint: Joint, other: Joint) -> Slip:
    def words(names: Names) -> SlipWords:
        # The student wrote this variable, so its name gives nothing away.
        index, name = joint.index, names.name(other.variable)
        clause = say("joint {joint} moves with {name}", joint=index, name=name)
        hint = say(
            "Joint {joint} moves with {name}: that is the variable of joint {other}.",
            joint=index,
            name=name,
            other=other.index,
        )
        return SlipWords(clause, hint, _moves_with(joint, names.name(joint.variable)))

    symbols = (SymbolChange(joint.variable, other.variable),)
    return Slip(JOINT_VARIABLE_INDEX, words, symbols=symbols)


def _joint_variable_doubled(joint: Joint) -> Slip:
    def words(names: Names) -> SlipWords:
        index, name = joint.index, names.shown(joint.variable)
        clause = say("joint {joint} moves twice as far as its variable", joint=index)
        hint = say(
            "Joint {joint} moves twice as far as its variable: count each joint variable once.",
            joint=index,
        )
        if name:
            clause = say("joint {joint} moves twice as far as {name}", joint=index, name=name)
            hint = say(
                "Joint {joint} moves twice as far as {name}: count each joint variable once.",
                joint=index,
                name=name,
            )
        correction = say(
            "Joint {joint} moves by {name}.", joint=index, name=names.name(joint.variable)
        )
        return SlipWords(clause, hint, correction)

    symbols = (SymbolChange(joint.variable, joint.variable, 2.0),)
    return Slip(JOINT_VARIABLE_DOUBLED, words, symbols=symbols)


def _zero_position(joint: Joint) -> Iterator[Slip]:
    # The joint's angle is measured from another zero position.
    yield _turned_joint(joint, QUARTER_TURN, np.pi / 2)
    yield _turned_joint(joint, QUARTER_TURN, -np.pi / 2)
    yield _turned_joint(joint, HALF_TURN, np.pi)


def _turned_joint(joint: Joint, kind: Record, turn: float) -> Slip:
    def words(names: Names) -> SlipWords:
        hint = say(
            "Joint {joint} starts from another position: check how the link lies when its variable "
            "is 0.",
            joint=joint.index,
        )
        variable = names.name(joint.variable)
        correction = say("{name} is off by a quarter turn (90°).", name=variable)
        if kind is HALF_TURN:
            correction = say("{name} is off by half a turn (180°).", name=variable)
        clause = say("joint {joint} starts from another position", joint=joint.index)
        return SlipWords(clause, hint, correction)

    symbols = (SymbolChange(joint.variable, joint.variable, 1.0, turn),)
    return Slip(kind, words, symbols=symbols)


def home_slip(joints: Sequence[Joint]) -> Iterator[Slip]:
    """Yield the slip in which all joint variables are 0."""
    if len(joints) > 1:
        symbols = tuple(SymbolChange(each.variable, each.variable, 0.0) for each in joints)
        yield Slip(HOME_POSITION, _at_home, symbols=symbols)


def _at_home(_: Names) -> SlipWords:
    return SlipWords(
        say("all joints stand in their home position"),
        say("All joints stand in their home position: the answer must change with the joints."),
    )


def axis_direction(exercise: Exercise, samples: Samples) -> Axis:
    """Return a function that says in words which way the axis of a joint points."""

    # The axes are computed on the first call of the returned function.
    @cache
    def screws() -> Numbers:
        assert exercise.reference is not None
        return exercise.reference.screws(samples.values, samples.count)[:, 0]

    def direction(joint: Joint) -> Sentence:
        first = exercise.joints[0].index - 1
        at = exercise.joints.index(joint)
        cosine = screws()[at, 5 if joint.prismatic else 2]
        # Earlier joints turn the axis, unless they turn about an axis along z.
        turning = [not each.prismatic for each in exercise.joints[:at]]
        if (np.abs(screws()[:at][turning, 2]) < 1 - SAME_MOTION).any():
            cosine = 0.0
        if cosine < -1 + SAME_MOTION:
            return say("Its axis points opposite to {axis}.", axis=f"z{first}")
        if cosine > 1 - SAME_MOTION:
            return say("Its axis points along {axis}.", axis=f"z{first}")
        return say("Check which way its axis points.")

    return direction


# --- Slips in the cells of the robot's table that lead to a wrong pose
#
# A slip has the same code here as in a submitted table (table_cell).


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
