"""Slips in a single table cell."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from service.catalogue import Joint
from service.expressions.printing.spelling import PLAIN, spelling_for
from service.grading.diagnosis.formulas.quantity import quantity_of
from service.grading.diagnosis.wording import POSITIVE, axes_of_row, listed
from service.grading.diagnosis.wrong_value import (
    Hypotheses,
    WrongCell,
    differs,
    finding_on,
    undefined,
)
from service.grading.feedback import Finding
from service.grading.formula_text import sum_formula
from service.grading.judging.table import Judgement, column_scales
from service.grading.misconception import Repaired, Written, diagnosed
from service.grading.numerics.comparison import Match
from service.grading.numerics.joint_motion import coefficients
from service.grading.numerics.tolerances import ROUNDED_VALUE
from service.grading.part import Grading
from service.grading.reading.absent_variables import absent_names, joint_counted
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import THETA, D
from service.kinematics.factors import CellIndex
from service.kinematics.transforms import Numbers

SUM_COUNTS = (
    "A neighbouring joint has a parallel axis, so only the sum of the offsets along both counts."
)

CONVERTED = (
    "The joint variable was converted between degrees and radians. Leave out the factor: a joint "
    "variable is already an angle."
)

# The turn that an angle is off by may itself have been rounded.
ROUNDED_TURN = ROUNDED_VALUE * np.pi

# --- checks of the joint variables in the cell


def joint_variable_absent(case: WrongCell) -> Finding | None:
    """The cell contains a joint variable that the robot does not have, or a length like d1."""
    absent = sorted(absent_names([case.expression], case.samples))
    if not absent:
        return None
    known = {joint.index: joint for joint in case.joints}
    joint = known.get(joint_counted(absent[0]))
    if joint is not None and not joint.prismatic:
        lengths = [name for name in case.samples.values if re.fullmatch(r"d_?\d+", name)]
        has = f" It has {', '.join(lengths)}." if lengths else ""
        return finding_on(case, "unknown_symbol", f"This exercise has no {absent[0]}.{has}")
    why = f"its joints are {min(known)} to {max(known)}"
    if joint is not None:
        why = f"joint {joint.index} {_motion(joint)}, and its variable is {case.name(joint)}"
    return finding_on(case, "joint_variable_absent", f"This robot has no {absent[0]}: {why}.")


def joint_variable_missing(case: WrongCell) -> Finding | None:
    """The table was taken to describe the drawn pose, so the joint variable was left out."""
    if case.joint is None or not case.required or case.contained != {}:
        return None
    return finding_on(
        case,
        "joint_variable_missing",
        f"Joint {case.joint.index} {_motion(case.joint)}, so this cell must contain its variable.",
    )


def _motion(joint: Joint) -> str:
    return "slides along z" if joint.prismatic else "turns about z"


def joint_variable_sign(case: WrongCell) -> Finding | None:
    """The joint was taken to move in the negative sense of its axis."""
    opposite = {joint: -count for joint, count in case.required.items()}
    if case.joint is None or not opposite or case.contained != opposite:
        return None
    return finding_on(
        case,
        "joint_variable_sign",
        f"The sign of the joint variable is wrong: check which way z points along this joint's "
        f"axis, and in which sense the joint {_motion(case.joint)}.",
    )


def joint_variable_index(case: WrongCell) -> Finding | None:
    """The variable of a neighbouring joint was taken."""
    other, count = case.contained_alone
    if not (case.joint and other and case.required) or other == case.joint or abs(count) != 1:
        return None
    return finding_on(
        case,
        "joint_variable_index",
        f"This is the row of joint {case.joint.index}, but the cell contains {case.name(other)}, "
        f"the variable of joint {other.index}.",
    )


def joint_variable_doubled(case: WrongCell) -> Finding | None:
    """The joint variable was counted more than once."""
    joint, count = case.contained_alone
    if joint is None or joint != case.joint or joint not in case.required or abs(count) < 2:
        return None
    return finding_on(
        case,
        "joint_variable_doubled",
        f"The joint variable has a wrong factor: check how far the joint "
        f"{'slides' if joint.prismatic else 'turns'} when the variable grows by 1.",
    )


def joint_variable_converted(case: WrongCell) -> Finding | None:
    """The joint variable, or the whole cell, was multiplied by π/180 or 180/π."""
    if not case.angle or not case.required or case.contained is not None:
        return None
    constant = case.constants[1]
    moved, motion = case.actual - constant, case.expected - constant

    def is_converted(convert: Callable[[Numbers], Numbers]) -> bool:
        return case.equal(moved, convert(motion)) or case.equal(case.actual, convert(case.expected))

    if is_converted(np.degrees):
        return finding_on(case, "degrees_as_radians", CONVERTED)
    return finding_on(case, "radians_as_degrees", CONVERTED) if is_converted(np.radians) else None


def joint_variable_column(case: WrongCell) -> Finding | None:
    """The joint variable was put in the column that stays constant for this kind of joint."""
    joint, _ = case.contained_alone
    if joint is None or joint != case.joint or case.required:
        return None
    moves, column = ("slides", "d") if joint.prismatic else ("turns", "θ")
    return finding_on(
        case,
        "joint_variable_column",
        f"Joint {joint.index} {moves}, so its variable belongs in {column}; {case.symbol} is "
        f"constant here.",
    )


def joint_variable_extra(case: WrongCell) -> Finding | None:
    """A joint variable was added that has nothing to do with this cell."""
    extra = [case.name(joint) for joint in case.contained or () if joint not in case.required]
    if not extra:
        return None
    return finding_on(
        case,
        "joint_variable_extra",
        f"The cell contains {listed(extra)}: check whether {case.symbol} changes with "
        f"{'it' if len(extra) == 1 else 'them'}.",
    )


def wrong_quantity(case: WrongCell) -> Finding | None:
    """An angle where a length is asked for, or a length where an angle is."""
    found = quantity_of(case.expression.tree)
    if found not in ("angle", "length") or (found == "angle") == case.angle:
        return None
    asked, written = ("an angle", "a length") if case.angle else ("a length", "an angle")
    return finding_on(
        case, "wrong_quantity", f"{case.symbol} is {asked}, but {written} is written here."
    )


# --- misconceptions about the constant, where the joint variables are right


def sign(case: WrongCell) -> Hypotheses:
    """The size is right, the direction is not."""
    finding = finding_on(
        case,
        "sign",
        f"The sign of {case.symbol} is wrong: it must be measured {case.measured}, positive "
        f"{POSITIVE[case.column]}.",
    )
    yield Written(-case.constants[1], finding)


def distance_left_out(case: WrongCell) -> Hypotheses:
    """A distance between the frames was overlooked."""
    finding = finding_on(
        case,
        "distance_left_out",
        f"A distance is left out of {case.symbol}{_beside(case)}: the two frames are apart "
        f"{case.measured}.",
    )
    yield Written(0 * case.actual, finding)


def distance_extra(case: WrongCell) -> Hypotheses:
    """A distance was put where there is none: into the wrong cell, or counted twice."""
    finding = finding_on(
        case,
        "distance_extra",
        f"Check whether the distance in {case.symbol}{_beside(case)} belongs there: it may lie "
        "along another axis, or stand in another cell already.",
    )
    yield Repaired(0 * case.actual, finding)


def _beside(case: WrongCell) -> str:
    return " beside the joint variable" if case.required else ""


def degrees_as_radians(case: WrongCell) -> Hypotheses:
    """A number in degrees was handed in where radians are read."""
    hint = (
        "This number was read in radians, but it fits in degrees: write the unit behind it "
        "(deg or °)."
    )
    in_degrees = np.radians(case.constants[0])
    for value, also in ((in_degrees, ""), (-in_degrees, " The sign is wrong, too.")):
        yield Repaired(value, finding_on(case, "degrees_as_radians", hint + also))


def radians_as_degrees(case: WrongCell) -> Hypotheses:
    """A number in radians was handed in where degrees are read."""
    finding = finding_on(
        case,
        "radians_as_degrees",
        "This number was read in degrees, but it fits in radians: write the unit behind it (rad).",
    )
    yield Repaired(np.degrees(case.constants[0]), finding)


def quarter_turn(case: WrongCell) -> Hypotheses:
    """A turn by 90° was left out, added, or made the wrong way from a quarter to three quarters."""
    finding = finding_on(
        case,
        "quarter_turn",
        _compare_axes(case),
        otherwise="It is off by a quarter turn (90°).",
    )
    for turn in (np.pi / 2, -np.pi / 2):
        yield Written(case.constants[1] + turn, finding, tolerance=ROUNDED_TURN)


def _compare_axes(case: WrongCell) -> str:
    axis, where = "z", ""
    if case.column == THETA:
        axis, where = "x", " in the home position" if case.joint else ""
    last = max((joint.index for joint in case.joints), default=0)
    axes = axes_of_row(axis, case.label, last)
    return f"{case.symbol} is not right: compare {axes}{where}."


def half_turn(case: WrongCell) -> Hypotheses:
    """An axis was taken to point the opposite way."""
    finding = finding_on(
        case,
        "half_turn",
        _compare_axes(case),
        otherwise="It is off by half a turn (180°).",
    )
    yield Written(case.constants[1] + np.pi, finding, tolerance=ROUNDED_TURN)


CHECKS = (
    joint_variable_absent,
    undefined,
    joint_variable_missing,
    joint_variable_sign,
    joint_variable_index,
    joint_variable_doubled,
    joint_variable_converted,
    joint_variable_column,
    joint_variable_extra,
    wrong_quantity,
)
# The codes of a joint variable in the column that stays constant.
MISPLACED = (joint_variable_absent.__name__, joint_variable_column.__name__)
# The work of one wrong cell, as the budget counts it.
CELL_WORK = 1.2
OF_DISTANCE = (distance_left_out, distance_extra)
OF_ANGLE = (degrees_as_radians, radians_as_degrees, quarter_turn, half_turn)
MISCONCEPTIONS = (sign, *OF_DISTANCE, *OF_ANGLE)


def diagnose(case: WrongCell) -> Finding:
    """The finding on a wrong cell."""
    misconceptions = (sign, *(OF_ANGLE if case.angle else OF_DISTANCE))
    finding = diagnosed(case, misconceptions, CHECKS) or differs(
        case,
        f"{case.symbol} is not right: check the {'angle' if case.angle else 'distance'} "
        f"{case.measured}.{_too_large(case)}{_in_symbols(case)}",
    )
    if case.column == D and case.shared and case.same_motion:
        return replace(finding, hint=f"{finding.hint} {SUM_COUNTS}")
    return finding


def _too_large(case: WrongCell) -> str:
    if not case.angle or not case.same_motion or np.abs(case.constants[0]).max() < 3 * np.pi:
        return ""
    return " It was read in radians: write the unit behind it (deg or °) if degrees were meant."


def _in_symbols(case: WrongCell) -> str:
    """The advice for a number where a length of the exercise is expected; it names none of them."""
    expected = case.constants[1]
    if case.angle or case.expression.symbols:
        return ""
    if case.equal(expected, np.full_like(expected, expected[0])):
        return ""
    return " Give it in the exercise's symbols."


def _by_joint(counts: tuple[int, ...] | None, joints: tuple[Joint, ...]) -> dict[Joint, int] | None:
    """Those of the joints that are contained at all, and how often."""
    if counts is None:
        return None
    return {joint: count for joint, count in zip(joints, counts, strict=True) if count}


def wrong_cells(judgement: Judgement, grading: Grading) -> dict[CellIndex, WrongCell]:
    """The wrong cells that were read, by row and column, as far as the work budget allows."""
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
    # A hint names no symbols but joint variables that the cell contains.
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
    """The finding on each of the wrong cells."""
    slips = {cell: diagnose(case) for cell, case in cases.items()}
    return _of_misplaced_variables(slips, judgement)


def _of_misplaced_variables(
    slips: dict[CellIndex, Finding], judgement: Judgement
) -> dict[CellIndex, Finding]:
    """The findings with one for both cells where a joint's variable stands in the other's place.

    Where the angle of a sliding joint has its variable, or a name like theta3, the offset lacks it.
    """
    told = dict(slips)
    for (i, column), finding in slips.items():
        joint = judgement.rows[i].joint
        if finding.code != joint_variable_missing.__name__ or joint is None:
            continue
        other = slips.get((i, THETA if column == D else D))
        if other is not None and other.code in MISPLACED:
            told[i, column] = replace(other, correction=finding.correction)
    return told
