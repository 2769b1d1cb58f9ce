"""Slips in a single table cell."""

from dataclasses import replace

import numpy as np

from service.expressions import Expression
from service.grading.comparison import Match
from service.grading.diagnosis.wrong_value import Hypotheses, WrongCell, differs, undefined
from service.grading.feedback import Finding
from service.grading.formula_text import sum_text
from service.grading.joint_motion import coefficients
from service.grading.judging.table import JudgedRow, Judgement, column_scales
from service.grading.misconception import Repaired, Written, diagnosed
from service.grading.part import Grading
from service.grading.reading.table import IS_ANGLE, HandedInRow
from service.grading.tolerances import ROUNDED_VALUE
from service.kinematics.chain import COLUMNS

SUM_COUNTS = (
    "The axis is parallel to its neighbour, so it is the sum of the offsets along it that counts."
)

# --- checks of the joint variables in the cell


def joint_variable_missing(case: WrongCell) -> Finding | None:
    """The table was taken to describe the drawn pose, so the joint variable was left out."""
    if (
        case.joint is None
        or not any(case.expected_coefficients)
        or case.actual_coefficients is None
        or any(case.actual_coefficients)
    ):
        return None
    return Finding(
        "joint_variable_missing",
        f"Joint {case.joint.index} {_moves(case)}, so this cell must contain its variable.",
        case.correction,
    )


def joint_variable_sign(case: WrongCell) -> Finding | None:
    """The joint was taken to move in the negative sense of its axis."""
    if case.actual_coefficients is None or not any(case.expected_coefficients):
        return None
    if case.actual_coefficients != tuple(-count for count in case.expected_coefficients):
        return None
    return Finding(
        "joint_variable_sign",
        f"The joint variable has the wrong sign: look which way z points on this joint's axis, and "
        f"turn or slide {case.measured} by the right-hand rule.",
        case.correction,
    )


def joint_variable_index(case: WrongCell) -> Finding | None:
    """The variable of a neighbouring joint was taken."""
    if (
        case.joint is None
        or not any(case.expected_coefficients)
        or case.actual_coefficients is None
    ):
        return None
    place = case.joints.index(case.joint)
    counts = case.actual_coefficients
    if counts[place] or sum(map(abs, counts)) != 1:
        return None
    other = case.joints[next(i for i, count in enumerate(counts) if count)]
    return Finding(
        "joint_variable_index",
        f"This is the row of joint {case.joint.index}, but the cell contains {other.variable}, the "
        f"variable of joint {other.index}.",
        case.correction,
    )


def joint_variable_doubled(case: WrongCell) -> Finding | None:
    """The joint variable was counted more than once."""
    if case.joint is None or case.actual_coefficients is None:
        return None
    place = case.joints.index(case.joint)
    count = case.actual_coefficients[place]
    if not case.expected_coefficients[place] or abs(count) < 2 or _others(case, place):
        return None
    return Finding(
        "joint_variable_doubled",
        f"{case.joint.variable} is contained {abs(count)} times; it belongs here once.",
        case.correction,
    )


def joint_variable_column(case: WrongCell) -> Finding | None:
    """The joint variable was put in the column that stays constant for this kind of joint."""
    if case.joint is None or any(case.expected_coefficients) or case.actual_coefficients is None:
        return None
    place = case.joints.index(case.joint)
    if not case.actual_coefficients[place] or _others(case, place):
        return None
    kind = "slides, so its variable is d" if case.joint.prismatic else "turns, so its variable is θ"
    return Finding(
        "joint_variable_column",
        f"Joint {case.joint.index} {kind}; {case.symbol} is constant here.",
        case.correction,
    )


def joint_variable_extra(case: WrongCell) -> Finding | None:
    """A joint variable was added that has nothing to do with this cell."""
    if case.actual_coefficients is None:
        return None
    extra = [
        joint.variable
        for joint, actual, expected in zip(
            case.joints, case.actual_coefficients, case.expected_coefficients, strict=True
        )
        if actual and not expected
    ]
    if not extra:
        return None
    return Finding(
        "joint_variable_extra",
        f"{' and '.join(extra)} must not be in this cell: it does not change {case.symbol} of this "
        "row.",
        case.correction,
    )


def _others(case: WrongCell, place: int) -> bool:
    """Whether the cell contains a variable of another joint than that at ``place``."""
    counts = case.actual_coefficients or ()
    return any(count for i, count in enumerate(counts) if i != place)


def _moves(case: WrongCell) -> str:
    return "slides along z" if case.joint and case.joint.prismatic else "turns about z"


# --- misconceptions about the constant, where the joint variables are right


def sign(case: WrongCell) -> Hypotheses:
    """The size is right, the direction is not."""
    finding = Finding(
        "sign",
        f"The sign of {case.symbol} is wrong: measure the {'turn' if case.angle else 'distance'} "
        f"{case.measured}, positive in the direction of that axis.",
        case.correction,
    )
    yield Written(-case.constants[1], finding)


def distance_left_out(case: WrongCell) -> Hypotheses:
    """A distance between the frames was overlooked."""
    finding = Finding(
        "distance_left_out",
        f"A distance is left out of {case.symbol}{_beside(case)}: these two frames are apart "
        f"{case.measured}.",
        case.correction,
    )
    if not case.angle:
        yield Written(0 * case.actual, finding)


def distance_extra(case: WrongCell) -> Hypotheses:
    """A distance was put where there is none: into the wrong cell, or counted twice."""
    finding = Finding(
        "distance_extra",
        f"There is no distance {case.measured} here{_beside(case)}: look along which axis of which "
        f"frame it is measured.",
        case.correction,
    )
    if not case.angle:
        yield Repaired(0 * case.actual, finding)


def _beside(case: WrongCell) -> str:
    return " beside the joint variable" if any(case.expected_coefficients) else ""


def degrees_as_radians(case: WrongCell) -> Hypotheses:
    """A number in degrees was handed in where radians are read."""
    hint = (
        "This number was read in radians, but it fits in degrees: write the unit (90deg or 90°), "
        "or write it with pi."
    )
    if case.angle:
        in_degrees = np.radians(case.constants[0])
        for value, also in ((-in_degrees, " Its sign is wrong, too."), (in_degrees, "")):
            yield Repaired(value, Finding("degrees_as_radians", hint + also, case.correction))


def radians_as_degrees(case: WrongCell) -> Hypotheses:
    """A number in radians was handed in where degrees are read."""
    finding = Finding(
        "radians_as_degrees",
        "This number was read in degrees, but it fits in radians: write it with pi, or in degrees.",
        case.correction,
    )
    if case.angle:
        yield Repaired(np.degrees(case.constants[0]), finding)


def quarter_turn(case: WrongCell) -> Hypotheses:
    """A turn by 90° was left out, added, or made the wrong way from a quarter to three quarters."""
    finding = Finding(
        "quarter_turn",
        f"{case.symbol} is off by a quarter turn (90°): compare the two axes that it is measured "
        f"between, in the home configuration.",
        case.correction,
    )
    for turn in (np.pi / 2, -np.pi / 2):
        yield from _off_by(turn, case, finding)


def half_turn(case: WrongCell) -> Hypotheses:
    """An axis was taken to point the opposite way."""
    finding = Finding(
        "half_turn",
        f"{case.symbol} is off by half a turn (180°): check which way the axes point that it is "
        f"measured between.",
        case.correction,
    )
    yield from _off_by(np.pi, case, finding)


def _off_by(turn: float, case: WrongCell, finding: Finding) -> Hypotheses:
    """The angle with another turn, which may itself have been rounded."""
    if case.angle:
        yield Written(case.constants[1] + turn, finding, tolerance=ROUNDED_VALUE * np.pi)


CHECKS = (
    undefined,
    joint_variable_missing,
    joint_variable_sign,
    joint_variable_index,
    joint_variable_doubled,
    joint_variable_column,
    joint_variable_extra,
)
MISCONCEPTIONS = (
    sign,
    distance_left_out,
    distance_extra,
    degrees_as_radians,
    radians_as_degrees,
    quarter_turn,
    half_turn,
)


def diagnose(case: WrongCell) -> Finding:
    """The finding on a wrong cell."""
    finding = diagnosed(case, MISCONCEPTIONS, CHECKS) or differs(
        case,
        f"{case.symbol} is not right here: measure the {'angle' if case.angle else 'distance'} "
        f"{case.measured} again.{_too_large(case)}",
    )
    if case.column == "d" and case.shared and case.same_motion:
        return replace(finding, hint=f"{finding.hint} {SUM_COUNTS}")
    return finding


def _too_large(case: WrongCell) -> str:
    """A hint where a number is far too large for radians."""
    if not case.angle or not case.same_motion or np.abs(case.constants[0]).max() < 3 * np.pi:
        return ""
    return " Its number was read in radians: write the unit (90deg or 90°) if degrees were meant."


def diagnose_cells(judgement: Judgement, grading: Grading) -> dict[tuple[int, int], Finding]:
    """The finding on each wrong cell that was read, by row and column."""
    written: list[tuple[int, int, JudgedRow, HandedInRow, Expression]] = []
    for i, column in np.argwhere(judgement.matches < Match.ROUNDED).tolist():
        judged = judgement.rows[i]
        expression = judged.row.entries[column].expression if judged.row else None
        if judged.row is not None and expression is not None:
            written.append((i, column, judged, judged.row, expression))
    if not written:
        return {}
    joints, samples = grading.exercise.robot.joints, grading.samples
    actual = [row.handed_in[column] for _, column, _, row, _ in written]
    expected = [judged.expected[column] for _, column, judged, _, _ in written]
    angles = [bool(IS_ANGLE[column]) for _, column, *_ in written]
    contained = coefficients(np.array(actual + expected), joints, samples, np.array(angles * 2))
    scales = column_scales(grading).tolist()
    slips = {}
    for k, (i, column, judged, _, expression) in enumerate(written):
        wanted = contained[len(written) + k]
        slips[i, column] = diagnose(
            WrongCell(
                expression=expression,
                actual=actual[k],
                expected=expected[k],
                expected_text=sum_text(expected[k], wanted, angles[k], grading.exercise, samples),
                samples=samples,
                scale=scales[column],
                angle=angles[k],
                column=COLUMNS[column],
                joint=judged.joint,
                joints=joints,
                actual_coefficients=contained[k],
                expected_coefficients=wanted or (0,) * len(joints),
                shared=judged.shared,
            )
        )
    return slips
