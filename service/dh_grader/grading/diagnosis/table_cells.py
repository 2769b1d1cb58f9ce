"""Slips in single cells of a table: the constant, the joint variable, or a whole DH row.

This file knows what is wrong in a cell that was judged wrong. What is wrong with a table as a whole
is in ``whole_tables.py`` and ``table_readings.py``.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dh_grader.catalogue import Joint
from dh_grader.expressions.printing import PLAIN, spelling_for
from dh_grader.grading.diagnosis.formulas import quantity_of
from dh_grader.grading.judging import Grading
from dh_grader.grading.judging_table import Judgement, column_scales
from dh_grader.grading.misconception import (
    UNEXPLAINED,
    Hypotheses,
    Repaired,
    Written,
    WrongCell,
    WrongNumbers,
    axes_of_row,
    check,
    diagnosed,
    differs,
    finding_on,
    misconception,
    register,
    says,
    sum_formula,
)
from dh_grader.grading.numbers import EXACT_VALUE, ROUNDED_VALUE, Match, coefficients
from dh_grader.grading.reading.entries import joint_counted
from dh_grader.grading.reading.table import IS_ANGLE
from dh_grader.grading.report import Finding
from dh_grader.kinematics import (
    THETA,
    A,
    CellIndex,
    Convention,
    D,
    Matrices,
    Numbers,
    dh1_residual,
    dh2_residual,
    inverse,
    row,
)
from dh_grader.translations import Sentence, listed, paragraph, say, template

# --- The wrong cells of a table, and the finding on each


SUM_COUNTS = say(
    "A neighbouring joint has a parallel axis, so only the sum of the offsets along both counts."
)

# The codes of a joint variable in the column that is constant for its joint.
MISPLACED = ("joint_variable_absent", "joint_variable_column")
# The work of one wrong cell, as the budget counts it.
CELL_WORK = 1.2


def wrong_cells(judgement: Judgement, grading: Grading) -> dict[CellIndex, WrongCell]:
    """Return the wrong readable cells by row and column; the work budget limits their number."""
    if not judgement.wrong:
        return {}
    written = [
        (i, column, judged, row.handed_in[column], expression)
        for i, column in np.argwhere(judgement.matches < Match.ROUNDED).tolist()
        if (row := (judged := judgement.rows[i]).row) is not None
        and (expression := row.entries[column].expression) is not None
        and grading.affords(CELL_WORK)
    ]
    if not written:
        return {}
    joints, samples = grading.exercise.robot.joints, grading.samples
    wanted = [judged.expected[column] for _, column, judged, *_ in written]
    angles = [bool(IS_ANGLE[column]) for _, column, *_ in written]
    values = np.array([actual for *_, actual, _ in written] + wanted)
    counts = coefficients(values, joints, samples, np.array(angles * 2))
    scales = column_scales(grading).tolist()
    spelling = PLAIN
    # Below the level ``full``, only the joint variables in the cell are named.
    if grading.corrects or any(map(any, filter(None, counts[: len(written)]))):
        rows = [judged.row for judged in judgement.rows if judged.row is not None]
        spelling = grading.spelling(entry for row in rows for entry in row.entries)
    cases: dict[CellIndex, WrongCell] = {}
    for k, (i, column, judged, actual, expression) in enumerate(written):
        contained, required = counts[k], counts[len(written) + k]
        own, correction = spelling, None
        if spelling is not PLAIN:
            own = spelling_for(expression.typed, spelling, grading.exercise.vocabulary)
        if grading.corrects:
            exercise = grading.exercise
            correction = sum_formula(wanted[k], required, angles[k], exercise, samples, own)
        cases[i, column] = WrongCell(
            expression=expression,
            actual=actual,
            expected=wanted[k],
            correction=correction,
            corrects=grading.corrects,
            spelling=own,
            samples=samples,
            scale=scales[column],
            angle=angles[k],
            column=column,
            joint=judged.joint,
            contained=_by_joint(contained, joints),
            required=_by_joint(required, joints) or {},
            shared=judged.shared,
            joints=joints,
            label=judged.label,
        )
    return cases


def _by_joint(counts: tuple[int, ...] | None, joints: tuple[Joint, ...]) -> dict[Joint, int] | None:
    if counts is None:
        return None
    return {joint: count for joint, count in zip(joints, counts, strict=True) if count}


def diagnose_cells(
    cases: Mapping[CellIndex, WrongCell], judgement: Judgement
) -> dict[CellIndex, Finding]:
    """Return the finding on each wrong cell.

    A variable that is in the wrong column, and missing in its own, has one finding for both cells.
    """
    slips = {cell: diagnose(case) for cell, case in cases.items()}
    told = dict(slips)
    for (i, column), finding in slips.items():
        joint = judgement.rows[i].joint
        if finding.code != "joint_variable_missing" or joint is None:
            continue
        other = slips.get((i, THETA if column == D else D))
        if other is not None and other.code in MISPLACED:
            told[i, column] = replace(other, correction=finding.correction)
    return told


def diagnose(case: WrongCell) -> Finding:
    """Return the finding on a wrong cell."""
    finding = diagnosed(case)
    assert finding is not None
    if case.column == D and case.shared and case.same_motion:
        return replace(finding, hint=paragraph(finding.hint, SUM_COUNTS))
    return finding


# --- Slips in the constant of a cell, if its joint variables are right


# The numbers of an angle with a wrong turn may be rounded, too.
ROUNDED_TURN = ROUNDED_VALUE * np.pi


@misconception(
    of=WrongCell,
    rank=100,
    code="sign",
    rule="of_column",
    means=template("a length or an angle has the wrong sign"),
    example=("stanford-arm", "table", {"1/alpha": "pi/2"}),
    unlike={"1/alpha": "0"},
)
def sign(case: WrongCell) -> Hypotheses:
    """The constant in the cell has the wrong sign."""
    hint = say(
        "The sign of {symbol} is wrong: it must be measured along {axis}, positive in the "
        "direction of the axis.",
        symbol=case.symbol,
        axis=case.axis,
    )
    if case.angle:
        hint = say(
            "The sign of {symbol} is wrong: it must be measured about {axis}, positive by the "
            "right-hand rule.",
            symbol=case.symbol,
            axis=case.axis,
        )
    yield Written(-case.constants[1], finding_on(case, hint))


@misconception(
    of=WrongCell,
    rank=110,
    code="distance_left_out",
    rule="of_column",
    when=lambda case: not case.angle,
    means=template("a distance between two frames is missing"),
    example=("stanford-arm", "table", {"6/d": "0"}),
    unlike={"2/d": "d6"},
)
def distance_left_out(case: WrongCell) -> Hypotheses:
    """A distance between the frames is missing."""
    hint = say(
        "A distance is left out of {symbol}: the two frames are apart along {axis}.",
        symbol=case.symbol,
        axis=case.axis,
    )
    if case.required:
        hint = say(
            "A distance is left out of {symbol} beside the joint variable: the two frames are "
            "apart along {axis}.",
            symbol=case.symbol,
            axis=case.axis,
        )
    yield Written(0 * case.actual, finding_on(case, hint))


@misconception(
    of=WrongCell,
    rank=120,
    code="distance_extra",
    rule="of_column",
    when=lambda case: not case.angle,
    means=template("the cell contains a distance that does not belong there"),
    example=("stanford-arm", "table", {"1/a": "d2"}),
    unlike={"2/d": "d6"},
)
def distance_extra(case: WrongCell) -> Hypotheses:
    """The cell contains a distance that does not belong there."""
    hint = say(
        "Check whether the distance in {symbol} belongs there: it may lie along another axis, or "
        "stand in another cell already.",
        symbol=case.symbol,
    )
    if case.required:
        hint = say(
            "Check whether the distance in {symbol} beside the joint variable belongs there: it "
            "may lie along another axis, or stand in another cell already.",
            symbol=case.symbol,
        )
    yield Repaired(0 * case.actual, finding_on(case, hint))


@misconception(
    of=WrongCell,
    rank=130,
    code="degrees_as_radians",
    rule="angle_unit",
    when=lambda case: case.angle,
    means=template("a number of degrees is read in radians, or a variable is multiplied by 180/π"),
    example=("stanford-arm", "table", {"1/alpha": "-90"}),
    unlike={"1/alpha": "-91"},
)
def degrees_as_radians(case: WrongCell) -> Hypotheses:
    """A number was written in degrees, but is read in radians."""
    hint = say(
        "This number was read in radians, but it fits in degrees: write the unit behind it "
        "(deg or °)."
    )
    in_degrees = np.radians(case.constants[0])
    for value, also in ((in_degrees, ""), (-in_degrees, say("The sign is wrong, too."))):
        yield Repaired(value, finding_on(case, paragraph(hint, also)))


@misconception(
    of=WrongCell,
    rank=140,
    code="radians_as_degrees",
    rule="angle_unit",
    when=lambda case: case.angle,
    means=template("a number of radians is read in degrees, or a variable is multiplied by π/180"),
    example=(
        "stanford-arm",
        "table",
        (
            "0, -1.5708, 0, theta1 ↵ 0, 90, d2, theta2 ↵ 0, 0, d3, 0 ↵ 0, -90, 0, theta4 ↵ 0, 90, "
            "0, theta5 ↵ 0, 0, d6, theta6"
        ),
        "degrees",
    ),
    unlike={"6/d": "-d6"},
)
def radians_as_degrees(case: WrongCell) -> Hypotheses:
    """A number was written in radians, but is read in degrees."""
    finding = finding_on(
        case,
        say(
            "This number was read in degrees, but it fits in radians: write the unit behind it "
            "(rad)."
        ),
    )
    yield Repaired(np.degrees(case.constants[0]), finding)


@misconception(
    of=WrongCell,
    rank=150,
    code="quarter_turn",
    rule="of_column",
    when=lambda case: case.angle,
    means=template("an angle is off by 90°"),
    example=("stanford-arm", "table", {"2/theta": "theta2 + pi/2"}),
    unlike={"2/theta": "theta2 + pi"},
)
def quarter_turn(case: WrongCell) -> Hypotheses:
    """The angle differs by 90° from the correct angle."""
    finding = finding_on(
        case,
        _compare_axes(case),
        otherwise=say("It is off by a quarter turn (90°)."),
    )
    for turn in (np.pi / 2, -np.pi / 2):
        yield Written(case.constants[1] + turn, finding, tolerance=ROUNDED_TURN)


def _compare_axes(case: WrongCell) -> Sentence:
    last = max((joint.index for joint in case.joints), default=0)
    axes = axes_of_row("x" if case.column == THETA else "z", case.label, last)
    if case.column == THETA and case.joint:
        return say(
            "{symbol} is not right: compare {axes} in the home position.",
            symbol=case.symbol,
            axes=axes,
        )
    return say("{symbol} is not right: compare {axes}.", symbol=case.symbol, axes=axes)


@misconception(
    of=WrongCell,
    rank=160,
    code="half_turn",
    rule="of_column",
    when=lambda case: case.angle,
    means=template("an angle is off by 180°, because an axis points the opposite way"),
    example=("stanford-arm", "table", {"3/alpha": "180°"}),
    unlike={"6/d": "0"},
)
def half_turn(case: WrongCell) -> Hypotheses:
    """The angle differs by 180° from the correct angle."""
    finding = finding_on(
        case,
        _compare_axes(case),
        otherwise=say("It is off by half a turn (180°)."),
    )
    yield Written(case.constants[1] + np.pi, finding, tolerance=ROUNDED_TURN)


@check(
    of=WrongCell,
    rank=300,
    code=UNEXPLAINED,
    rule="of_column",
    means="the value is wrong, and no other code explains it: for example another length or angle",
    example=("stanford-arm", "table", {"2/d": "d6"}),
    unlike={"6/d": "0"},
)
def unexplained(case: WrongCell) -> Finding:
    """No misconception explains the cell."""
    hint = say(
        "{symbol} is not right: check the distance along {axis}.",
        symbol=case.symbol,
        axis=case.axis,
    )
    if case.angle:
        hint = say(
            "{symbol} is not right: check the angle about {axis}.",
            symbol=case.symbol,
            axis=case.axis,
        )
    return differs(case, paragraph(hint, _too_large(case), _in_symbols(case)))


def _too_large(case: WrongCell) -> str:
    if not case.angle or not case.same_motion or np.abs(case.constants[0]).max() < 3 * np.pi:
        return ""
    return say("It was read in radians: write the unit behind it (deg or °) if degrees were meant.")


def _in_symbols(case: WrongCell) -> str:
    expected = case.constants[1]
    if case.angle or case.expression.symbols:
        return ""
    if case.equal(expected, np.full_like(expected, expected[0])):
        return ""
    return say("Give it in the exercise's symbols.")


# --- Slips in the joint variables or the quantity (length or angle) of a table cell


CONVERTED = say(
    "The joint variable was converted between degrees and radians. Leave out the factor: a joint "
    "variable is already an angle."
)


@check(
    of=WrongCell,
    rank=2,
    code="unknown_symbol",
    rule="of_column",
    means=template(
        "the cell contains a length that the exercise does not have: d1 although joint 1 turns"
    ),
    example=("stanford-arm", "table", {"1/d": "d1"}),
    unlike={"6/d": "0"},
)
def unknown_length(case: WrongCell) -> Finding | None:
    """The cell contains a length that the exercise does not have."""
    name, joint = _absent(case)
    if joint is None or joint.prismatic:
        return None
    lengths = [name for name in case.samples.values if re.fullmatch(r"d_?\d+", name)]
    hint = say("This exercise has no {name}.", name=name)
    if lengths:
        hint = say(
            "This exercise has no {name}. It has {lengths}.", name=name, lengths=", ".join(lengths)
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=4,
    code="joint_variable_absent",
    rule="joint_variable",
    means=template(
        "the cell contains a joint variable that the robot does not have: θ0, or θ3 if "
        "joint 3 slides"
    ),
    example=("stanford-arm", "table", {"3/theta": "theta3"}),
    unlike={"3/theta": "d3"},
)
def joint_variable_absent(case: WrongCell) -> Finding | None:
    """The cell contains a joint variable that the robot does not have."""
    name, joint = _absent(case)
    if not name:
        return None
    if joint is None:
        indices = [each.index for each in case.joints]
        hint = say(
            "This robot has no {name}: its joints are {first} to {last}.",
            name=name,
            first=min(indices),
            last=max(indices),
        )
    else:
        # A turning joint has no variable d, which is a length that the exercise does not have.
        hint = say(
            "This robot has no {name}: joint {joint} slides along z, and its variable is "
            "{variable}.",
            name=name,
            joint=joint.index,
            variable=case.name(joint),
        )
    return finding_on(case, hint)


def _absent(case: WrongCell) -> tuple[str, Joint | None]:
    # A variable that the robot does not have ("" if there is none), and the joint with its number.
    absent = sorted(case.samples.absent_names([case.expression]))
    if not absent:
        return "", None
    index = joint_counted(absent[0])
    return absent[0], next((joint for joint in case.joints if joint.index == index), None)


@check(
    of=WrongCell,
    rank=20,
    code="joint_variable_missing",
    rule="joint_variable",
    means=template("the joint's variable is missing, so the table describes only the drawn pose"),
    example=("stanford-arm", "table", {"1/theta": "0"}),
    unlike={"1/theta": "-theta1"},
)
def joint_variable_missing(case: WrongCell) -> Finding | None:
    """The joint variable is missing in the cell."""
    if case.joint is None or not case.required or case.contained != {}:
        return None
    joint = case.joint.index
    hint = say("Joint {joint} turns about z, so this cell must contain its variable.", joint=joint)
    if case.joint.prismatic:
        hint = say(
            "Joint {joint} slides along z, so this cell must contain its variable.", joint=joint
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=25,
    code="joint_variable_sign",
    rule="joint_variable",
    means=template("the joint variable has the wrong sign"),
    example=("stanford-arm", "table", {"3/d": "-d3"}),
    unlike={"6/d": "0"},
)
def joint_variable_sign(case: WrongCell) -> Finding | None:
    """The joint variable has the wrong sign."""
    opposite = {joint: -count for joint, count in case.required.items()}
    if case.joint is None or not opposite or case.contained != opposite:
        return None
    hint = say(
        "The sign of the joint variable is wrong: check which way z points along this joint's "
        "axis, and in which sense the joint turns about z."
    )
    if case.joint.prismatic:
        hint = say(
            "The sign of the joint variable is wrong: check which way z points along this joint's "
            "axis, and in which sense the joint slides along z."
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=30,
    code="joint_variable_index",
    rule="joint_variable",
    means=template("the cell contains the variable of another joint"),
    example=("stanford-arm", "table", {"2/theta": "theta1"}),
    unlike={"2/theta": "2*theta2"},
)
def joint_variable_index(case: WrongCell) -> Finding | None:
    """The cell contains the variable of a neighbouring joint."""
    other, count = case.contained_alone
    if not (case.joint and other and case.required) or other == case.joint or abs(count) != 1:
        return None
    return finding_on(
        case,
        say(
            "This is the row of joint {joint}, but the cell contains {variable}, the variable of "
            "joint {other}.",
            joint=case.joint.index,
            variable=case.name(other),
            other=other.index,
        ),
    )


@check(
    of=WrongCell,
    rank=35,
    code="joint_variable_doubled",
    rule="joint_variable",
    means=template("the joint variable counts more than once"),
    example=("three-link-cylindrical", "table", {"3/d": "2*d3"}),
    unlike={"1/d": "2*d1"},
)
def joint_variable_doubled(case: WrongCell) -> Finding | None:
    """The joint variable is counted more than once."""
    joint, count = case.contained_alone
    if joint is None or joint != case.joint or joint not in case.required or abs(count) < 2:
        return None
    hint = say(
        "The joint variable has a wrong factor: check how far the joint turns when the variable "
        "grows by 1."
    )
    if joint.prismatic:
        hint = say(
            "The joint variable has a wrong factor: check how far the joint slides when the "
            "variable grows by 1."
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=40,
    code="degrees_as_radians",
    rule="angle_unit",
    means=template("a number of degrees is read in radians, or a variable is multiplied by 180/π"),
    example=("planar-rr", "table", {"1/theta": "180*theta1/pi"}),
    unlike={"1/d": "1"},
)
def cell_in_degrees(case: WrongCell) -> Finding | None:
    """The joint variable, or the whole cell, was multiplied by 180/π."""
    return finding_on(case, CONVERTED) if _is_converted(case, np.degrees) else None


@check(
    of=WrongCell,
    rank=45,
    code="radians_as_degrees",
    rule="angle_unit",
    means=template("a number of radians is read in degrees, or a variable is multiplied by π/180"),
    example=("planar-rr", "table", {"1/theta": "pi*theta1/180"}),
    unlike={"1/d": "1"},
)
def cell_in_radians(case: WrongCell) -> Finding | None:
    """The joint variable, or the whole cell, was multiplied by π/180."""
    return finding_on(case, CONVERTED) if _is_converted(case, np.radians) else None


def _is_converted(case: WrongCell, convert: Callable[[Numbers], Numbers]) -> bool:
    if not case.angle or not case.required or case.contained is not None:
        return False
    constant = case.constants[1]
    moved, motion = case.actual - constant, case.expected - constant
    return case.equal(moved, convert(motion)) or case.equal(case.actual, convert(case.expected))


@check(
    of=WrongCell,
    rank=50,
    code="joint_variable_column",
    rule="joint_variable",
    means=template(
        "the joint variable is in a column that must be constant: θ if the joint slides"
    ),
    example=("stanford-arm", "table", {"3/theta": "d3"}),
    unlike={"6/d": "0"},
)
def joint_variable_column(case: WrongCell) -> Finding | None:
    """The joint variable is in a column that must be constant."""
    joint, _ = case.contained_alone
    if joint is None or joint != case.joint or case.required:
        return None
    hint = say(
        "Joint {joint} turns, so its variable belongs in θ; {symbol} is constant here.",
        joint=joint.index,
        symbol=case.symbol,
    )
    if joint.prismatic:
        hint = say(
            "Joint {joint} slides, so its variable belongs in d; {symbol} is constant here.",
            joint=joint.index,
            symbol=case.symbol,
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=55,
    code="joint_variable_extra",
    rule="joint_variable",
    means=template("the cell contains a joint variable that it must not depend on"),
    example=("stanford-arm", "table", {"2/d": "d2 + d3"}),
    unlike={"2/d": "d6"},
)
def joint_variable_extra(case: WrongCell) -> Finding | None:
    """The cell contains a joint variable that should not be in the cell."""
    extra = [case.name(joint) for joint in case.contained or () if joint not in case.required]
    if not extra:
        return None
    hint = say(
        "The cell contains {variables}: check whether {symbol} changes with them.",
        variables=listed(extra),
        symbol=case.symbol,
    )
    if len(extra) == 1:
        hint = say(
            "The cell contains {variable}: check whether {symbol} changes with it.",
            variable=extra[0],
            symbol=case.symbol,
        )
    return finding_on(case, hint)


@check(
    of=WrongCell,
    rank=60,
    code="wrong_quantity",
    rule="of_column",
    means=template("the cell is an angle but must be a length, or a length but must be an angle"),
    example=("stanford-arm", "table", {"2/d": "90deg"}),
    unlike={"2/d": "d6"},
)
def wrong_quantity(case: WrongCell) -> Finding | None:
    """The cell is an angle instead of a length, or a length instead of an angle."""
    found = quantity_of(case.expression.tree)
    if found not in ("angle", "length") or (found == "angle") == case.angle:
        return None
    hint = say("{symbol} is a length, but an angle is written here.", symbol=case.symbol)
    if case.angle:
        hint = say("{symbol} is an angle, but a length is written here.", symbol=case.symbol)
    return finding_on(case, hint)


# --- Slips in the DH row of a transform, or in the answer that a transform has no DH row


@dataclass(frozen=True)
class WrongRow(WrongNumbers):
    """A wrong DH row ``(4, SAMPLES)`` of a transform ``(SAMPLES, 4, 4)``."""

    transform: Matrices
    convention: Convention
    angle: ClassVar[ArrayLike] = IS_ANGLE[:, None]

    def row_of(self, transform: Matrices, convention: Convention) -> Numbers | None:
        """Return the DH row ``(4, SAMPLES)`` of a transform, or None if it has no DH row."""
        length_scale = float(np.asarray(self.scale)[A])
        if violated(transform, convention, length_scale):
            return None
        return row(transform, convention)


@misconception(
    of=WrongRow,
    rank=10,
    code="exchanged_parameters",
    rule="convention",
    means="a and d, or α and θ, are exchanged",
    example=("dh-conditions", "fourth", {"a": "2", "alpha": "0", "d": "3", "theta": "pi/2"}),
    unlike={"a": "pi/2", "alpha": "0", "d": "2", "theta": "3"},
)
def exchanged_parameters(case: WrongRow) -> Hypotheses:
    """The student exchanged a and d, or α and θ."""
    for first, last, order in (("a", "d", [2, 1, 0, 3]), ("α", "θ", [0, 3, 2, 1])):
        hint = say(
            "{first} and {last} are exchanged: a and α are measured along and about x, d and θ "
            "along and about z.",
            first=first,
            last=last,
        )
        yield Written(case.expected[order], says(hint))
    both = say(
        "a and d, and α and θ are exchanged: a and α are measured along and about x, d and θ along "
        "and about z."
    )
    yield Written(case.expected[[2, 3, 0, 1]], says(both))


@misconception(
    of=WrongRow,
    rank=20,
    code="other_convention",
    rule="convention",
    means="the row follows the other convention",
    example=("several-kinds", "turned-row", "l, 0, a, pi"),
    unlike="l, 0, 2*a, pi",
)
def other_convention(case: WrongRow) -> Hypotheses:
    """The row describes the transform in the other DH convention."""
    other = case.convention.other
    hint = say("This is the row of the modified convention; the standard one is asked for.")
    if other is Convention.STANDARD:
        hint = say("This is the row of the standard convention; the modified one is asked for.")
    found = case.row_of(case.transform, other)
    if found is not None:
        yield Written(found, says(hint))


@misconception(
    of=WrongRow,
    rank=30,
    code="inverse_transform",
    rule="rows",
    means="the row describes the inverse transform",
    example=("several-kinds", "turn-row", "0, 0, -a, -phi"),
    unlike="0, 0, -a, phi",
)
def inverse_row(case: WrongRow) -> Hypotheses:
    """The row describes the inverse transform."""
    finding = says(
        say(
            "This is the row of the inverse: the transform describes the second frame in the first."
        ),
    )
    found = case.row_of(inverse(case.transform), case.convention)
    if found is not None:
        yield Written(found, finding)


# The conditions for a transform to have a row.
_NOT_PERPENDICULAR = register(
    of=WrongRow,
    code="dh_not_perpendicular",
    rule="convention",
    means="a row is given, but the transform has none: x is not perpendicular to z",
    example=("dh-conditions", "second", {"a": "l", "alpha": "0", "d": "h", "theta": "phi"}),
    unlike="l, 0, h",
)
_NOT_INTERSECTING = register(
    of=WrongRow,
    code="dh_not_intersecting",
    rule="convention",
    means="a row is given, but the transform has none: the lines of x and z do not meet",
    example=("dh-conditions", "third", {"a": "l", "alpha": "phi", "d": "h", "theta": "0"}),
    unlike="l, 0, h",
)
_ROW_EXISTS = register(
    of=WrongRow,
    code="dh_row_exists",
    rule="convention",
    means='the answer is "none", but the transform has a row',
    example=("dh-conditions", "fourth", {"none": True}),
    unlike={"a": "3", "alpha": "0", "d": "2", "theta": "0"},
)


def axes_named(convention: Convention) -> tuple[str, str]:
    """Return the names of the x axis and the z axis in the two DH conditions."""
    return ("x1", "z0") if convention is Convention.STANDARD else ("x0", "z1")


def violated(transform: Matrices, convention: Convention, length_scale: float) -> list[Finding]:
    """Return findings on the DH conditions that the transform violates."""
    x, z = axes_named(convention)
    row_of_entry, column = (3, 1) if convention is Convention.STANDARD else (1, 3)
    perpendicular = _NOT_PERPENDICULAR.finding(
        say(
            "Check the first DH condition: is {x} perpendicular to {z}? Check the entry in row "
            "{row}, column {column}.",
            x=x,
            z=z,
            row=row_of_entry,
            column=column,
        ),
        say("It is not 0, so that {x} is not perpendicular to {z} and there is no row.", x=x, z=z),
    )
    intersecting = _NOT_INTERSECTING.finding(
        say("Check the second DH condition: does the line of {x} meet the line of {z}?", x=x, z=z),
        say("It passes {z} at a distance, so that there is no row.", z=z),
    )
    conditions = (
        (perpendicular, dh1_residual, EXACT_VALUE),
        (intersecting, dh2_residual, EXACT_VALUE * length_scale),
    )
    return [
        finding
        for finding, residual, tolerance in conditions
        if np.abs(residual(transform, convention)).max() >= tolerance
    ]


def has_a_row(convention: Convention) -> Finding:
    """Return the finding on the wrong answer that a transform has no DH row."""
    x, z = axes_named(convention)
    return _ROW_EXISTS.finding(
        say(
            "Check both DH conditions: is {x} perpendicular to {z}, and does the line of {x} meet "
            "the line of {z}?",
            x=x,
            z=z,
        ),
        say("Both hold, so that there is a row."),
    )
