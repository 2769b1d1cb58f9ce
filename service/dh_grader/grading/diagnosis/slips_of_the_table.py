"""A slip: a mistake in the robot's table, joints or lengths, which leads to a wrong answer.

This file has the kinds of slips, and the slips of lengths and joints; ``whole_tables.py`` has those
of cells, rows and columns. ``upstream.py`` searches among them for the one that explains an answer.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations

import numpy as np

from dh_grader.catalogue import Exercise, Joint
from dh_grader.expressions.evaluate import SymbolValues
from dh_grader.grading.misconception import Record, register
from dh_grader.grading.numbers import SAME_MOTION, Samples
from dh_grader.kinematics import Numbers, Table
from dh_grader.translations import Sentence, paragraph, say

# --- A slip, and the values that it changes
#
# Many slips are tried at once: a single computation takes the changed inputs of all slips.


@dataclass(frozen=True, slots=True)
class SymbolChange:
    """A changed symbol: its value becomes ``factor`` times the ``source``, plus ``offset``."""

    symbol: str
    source: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class CellChange:
    """A changed constant of a cell: ``factor`` times the ``source``, plus ``offset``."""

    row: int
    column: int
    factor: float = 1.0
    offset: float = 0.0
    # The row and column of the cell whose constant is multiplied; None for the changed cell itself.
    source: tuple[int, int] | None = None
    # If True, the joint variables in the cells change along with the constants.
    moving: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """A change to the symbols or the table cells from which an answer is computed."""

    symbols: tuple[SymbolChange, ...] = ()
    cells: tuple[CellChange, ...] = ()
    # If True, the links are computed with the formula of the other convention.
    misread: bool = False


@dataclass(frozen=True, slots=True)
class Names:
    """The names of symbols in a message."""

    # Returns the name that the student uses for a symbol.
    name: Callable[[str], str]
    # True for a symbol whose name would reveal the correct entry.
    gives_away: Callable[[str], bool]

    def shown(self, symbol: str) -> str | None:
        """Return the name of a symbol, or None if the name would reveal the correct entry."""
        return None if self.gives_away(symbol) else self.name(symbol)


@dataclass(frozen=True, slots=True)
class SlipWords:
    """The sentences about a slip."""

    # What is wrong, in a clause, so that several slips can be listed.
    clause: Sentence
    # What is wrong and what to check, for this slip alone.
    hint: str
    correction: str = ""


@dataclass(frozen=True, slots=True)
class Slip(Change):
    """A possible mistake of a student: its kind, and the change that it makes."""

    kind: Record
    # Returns the sentences about the slip, with the names that the student uses.
    words: Callable[[Names], SlipWords]

    @property
    def code(self) -> str:
        """The code of the kind of slip, or the name of a kind without a code."""
        return self.kind.name


def changed_values(changes: Sequence[Change], values: SymbolValues) -> dict[str, Numbers]:
    """Return the values ``(K · samples,)`` of each symbol after each of K changes.

    The values after one change are consecutive.
    """
    names = list(values)
    if not names:
        return {}
    places = {name: i for i, name in enumerate(names)}
    right = np.array([values[name] for name in names])
    stacked = np.repeat(right[:, None], len(changes), axis=1)
    changed = [(k, symbol) for k, change in enumerate(changes) for symbol in change.symbols]
    if changed:
        targets = [places[each.symbol] for _, each in changed]
        sources = [places[each.source] for _, each in changed]
        factors = np.array([[each.factor] for _, each in changed])
        offsets = np.array([[each.offset] for _, each in changed])
        stacked[targets, [k for k, _ in changed]] = factors * right[sources] + offsets
    return dict(zip(names, stacked.reshape(len(names), -1), strict=True))


def change_cells(
    changes: Sequence[Change],
    tables: Table,
    right: Table,
    constants: Table,
    first_row: int = 0,
) -> None:
    """Apply each of K changes to its own table in ``tables``, in place.

    ``tables`` is ``(rows, 4, K, count)`` for ``count`` samples. ``right`` ``(rows, 4, count)`` is
    the correct table, ``constants`` the same table with all joint variables 0. All three arrays
    begin with row ``first_row`` of the whole table.
    """
    cells = [(k, cell) for k, change in enumerate(changes) for cell in change.cells]
    if not cells:
        return
    written = np.stack([constants, right])
    numbers = np.array(
        [
            (k, cell.moving, cell.row, cell.column, *(cell.source or (cell.row, cell.column)))
            for k, cell in cells
        ]
    ).T
    ways, moving, rows, columns, source_rows, source_columns = numbers
    rows, source_rows = rows - first_row, source_rows - first_row
    factors = np.array([[cell.factor] for _, cell in cells])
    offsets = np.array([[cell.offset] for _, cell in cells])
    sources = written[moving, source_rows, source_columns]
    tables[rows, columns, ways] += factors * sources - written[moving, rows, columns] + offsets


# --- The kinds of slips in the robot's table, joints or lengths, likeliest first


JOINT_VARIABLE_SIGN = register(
    of=Slip,
    rank=10,
    code="joint_variable_sign",
    rule="product",
    means="a joint moves in the wrong direction about or along its axis",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(q1 - q2), a1 s1 + a2 sin(q1 - q2)]"),
    unlike="[a1 c1 - a2 c12, a1 s1 - a2 s12]",
)
HOME_POSITION = register(
    of=Slip,
    rank=20,
    code="home_position",
    rule="product",
    means="the answer holds only for the home position",
    example=("planar-rr", "position", "[a1 + a2, 0]"),
    unlike={"2/1": "0"},
)
JOINT_VARIABLE_MISSING = register(
    of=Slip,
    rank=30,
    code="joint_variable_missing",
    rule="product",
    means="the variable of a joint is left out, so the joint does not move",
    example=("planar-rr", "position", "[(a1 + a2) c1, (a1 + a2) s1]"),
    unlike="[a1 c1, a1 s1]",
)
SIGN = register(
    of=Slip,
    rank=40,
    code="sign",
    rule="product",
    means="a length or an angle of the table has the wrong sign",
    example=("planar-rr", "position", "[a1 c1 - a2 c12, a1 s1 - a2 s12]"),
    unlike="[a1 c1, a1 s1]",
)
DISTANCE_LEFT_OUT = register(
    of=Slip,
    rank=50,
    code="distance_left_out",
    rule="product",
    means="a length of the table is left out",
    example=("planar-rr", "position", "[a1 c1, a1 s1]"),
    unlike="[a1 c1 - a2 c12, a1 s1 - a2 s12]",
)
QUARTER_TURN = register(
    of=Slip,
    rank=60,
    code="quarter_turn",
    rule="product",
    means="an angle of the table, or the zero position of a joint, is off by 90°",
    example=("planar-rr", "position", "[a1 c1 - a2 s12, a1 s1 + a2 c12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
COLUMNS_SWAPPED = register(
    of=Slip,
    rank=70,
    code="columns_swapped",
    rule="product",
    means="a and d are exchanged, throughout or in one row",
    example=(
        "planar-rr",
        "pose",
        "[c12, -s12, 0, 0; s12, c12, 0, 0; 0, 0, 1, a1 + a2; 0, 0, 0, 1]",
    ),
    unlike={"3/4": "a1"},
)
PARAMETER_SIGN = register(
    of=Slip,
    rank=80,
    code="parameter_sign",
    rule="product",
    means="one of a, α, d, θ has the wrong sign in every row",
    example=("three-link-cartesian", "position", "[-d3, -d2, d1]"),
    unlike="[d1, d2, d3]",
)
OTHER_CONVENTION = register(
    of=Slip,
    rank=90,
    code="other_convention",
    rule="convention",
    means="the table is multiplied out with the link transform of the other convention",
    example=(
        "spatial-rrr",
        "links",
        (
            "[c1, -s1, 0, R; 0, 0, -1, 0; s1, c1, 0, 0; 0, 0, 0, 1] ↵ [c2, -s2, 0, L1; s2, c2, 0, "
            "0; 0, 0, 1, 0; 0, 0, 0, 1] ↵ [c3, -s3, 0, L2; s3, c3, 0, 0; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"A1.2/4": "R*s2"},
)
LENGTHS_EXCHANGED = register(
    of=Slip,
    rank=100,
    code="lengths_exchanged",
    rule="product",
    means="two lengths of the table are exchanged",
    example=("planar-rr", "position", "[a2 c1 + a1 c12, a2 s1 + a1 s12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
OTHER_LENGTH = register(
    of=Slip,
    rank=110,
    code="other_length",
    rule="product",
    means="one length is used in place of another",
    example=("planar-rr", "position", "[a1 c1 + a1 c12, a1 s1 + a1 s12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
JOINT_VARIABLE_INDEX = register(
    of=Slip,
    rank=120,
    code="joint_variable_index",
    rule="product",
    means="a joint moves by the variable of another joint",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(2 q1), a1 s1 + a2 sin(2 q1)]"),
    unlike="[(a1 + a2) c1, (a1 + a2) s1]",
)
ANGLE_LEFT_OUT = register(
    of=Slip,
    rank=130,
    code="angle_left_out",
    rule="product",
    means="an angle of the table that is no multiple of 90° is left out",
    example=("arm", "position", "[a3 c1 c3 + b3 s1, a3 s1 c3 - b3 c1, a3 s3 + d2]"),
    unlike="[a3 c1 c3, a3 s1 c3, a3 s3 + d2]",
)
HALF_TURN = register(
    of=Slip,
    rank=140,
    code="half_turn",
    rule="product",
    means="an angle of the table, or the zero position of a joint, is off by 180°",
    example=(
        "planar-rr",
        "pose",
        "[-c12, s12, 0, a1*c1 - a2*c12; -s12, -c12, 0, a1*s1 - a2*s12; 0, 0, 1, 0; 0, 0, 0, 1]",
    ),
    unlike={"3/2": "1", "3/3": "0"},
)
JOINT_VARIABLE_DOUBLED = register(
    of=Slip,
    rank=150,
    code="joint_variable_doubled",
    rule="product",
    means="a joint variable counts twice",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(q1 + 2 q2), a1 s1 + a2 sin(q1 + 2 q2)]"),
    unlike="[a1 c1 + a2 cos(2 q1), a1 s1 + a2 sin(2 q1)]",
)
ROW_ORDER = register(
    of=Slip,
    rank=160,
    code="row_order",
    rule="product",
    means="two rows, or their link transforms, are exchanged",
    example=("turret", "position", "[a3 c1 c3, a3 s1 c3, a3 s3]"),
    unlike="[a3 c1 c2, a3 s1 c2, a3 s2]",
)
# Listed only together with exchanged rows. Otherwise the slips in products of links
# (``motions.py``) name the missing link.
MISSING_LINK = register(of=Slip, rank=170, name="missing_link")


# --- Slips in the lengths of an answer, such as a wrong sign


# Robots have a handful of lengths. With more, pairs are not tried.
MAX_LENGTHS = 12


def length_slips(lengths: Sequence[str], alone: Iterable[str] = ()) -> Iterator[Slip]:
    """Yield the slips in these lengths: wrong signs, missing lengths and exchanged lengths.

    For the lengths ``alone``, each of which is a whole cell of the table, only exchanges are
    yielded.
    """
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
            # The joint's angle is measured from another zero position.
            yield _turned_joint(joint, QUARTER_TURN, np.pi / 2)
            yield _turned_joint(joint, QUARTER_TURN, -np.pi / 2)
            yield _turned_joint(joint, HALF_TURN, np.pi)


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
