"""Slips in a single table cell."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from service.catalogue import Joint
from service.expressions.printing.spelling import PLAIN, spelling_for
from service.grading.diagnosis.wording import axes_of_row
from service.grading.diagnosis.wrong_value import (
    UNEXPLAINED,
    Hypotheses,
    WrongCell,
    differs,
    finding_on,
)
from service.grading.feedback import Finding
from service.grading.formula_text import sum_formula
from service.grading.judging.table import Judgement, column_scales
from service.grading.misconception import Repaired, Written, check, diagnosed, misconception
from service.grading.numerics.comparison import Match
from service.grading.numerics.joint_motion import coefficients
from service.grading.numerics.tolerances import ROUNDED_VALUE
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import THETA, D
from service.kinematics.factors import CellIndex
from service.translations import Sentence, paragraph, say, template

SUM_COUNTS = say(
    "A neighbouring joint has a parallel axis, so only the sum of the offsets along both counts."
)

# The numbers of an angle with a wrong turn may be rounded, too.
ROUNDED_TURN = ROUNDED_VALUE * np.pi

# --- misconceptions about the constant, if the joint variables are right


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


# The codes of a joint variable in the column that is constant for its joint.
MISPLACED = ("joint_variable_absent", "joint_variable_column")
# The work of one wrong cell, as the budget counts it.
CELL_WORK = 1.2


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


def diagnose(case: WrongCell) -> Finding:
    """Return the finding on a wrong cell."""
    finding = diagnosed(case)
    assert finding is not None
    if case.column == D and case.shared and case.same_motion:
        return replace(finding, hint=paragraph(finding.hint, SUM_COUNTS))
    return finding


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


def _by_joint(counts: tuple[int, ...] | None, joints: tuple[Joint, ...]) -> dict[Joint, int] | None:
    if counts is None:
        return None
    return {joint: count for joint, count in zip(joints, counts, strict=True) if count}


def wrong_cells(judgement: Judgement, grading: Grading) -> dict[CellIndex, WrongCell]:
    """Return the wrong readable cells by row and column."""
    # The work budget limits their number.
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


def diagnose_cells(
    cases: Mapping[CellIndex, WrongCell], judgement: Judgement
) -> dict[CellIndex, Finding]:
    """Return the finding on each wrong cell."""
    slips = {cell: diagnose(case) for cell, case in cases.items()}
    return _of_misplaced_variables(slips, judgement)


def _of_misplaced_variables(
    slips: dict[CellIndex, Finding], judgement: Judgement
) -> dict[CellIndex, Finding]:
    # For example, the variable of a sliding joint is in θ and missing in d: one finding for both
    # cells.
    told = dict(slips)
    for (i, column), finding in slips.items():
        joint = judgement.rows[i].joint
        if finding.code != "joint_variable_missing" or joint is None:
            continue
        other = slips.get((i, THETA if column == D else D))
        if other is not None and other.code in MISPLACED:
            told[i, column] = replace(other, correction=finding.correction)
    return told
