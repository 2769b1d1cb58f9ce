"""Slips in a single table cell.

Each function is one misconception that the student may have held. It returns what to say where the
misconception explains the cell exactly, else None. The first that explains it is told.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from service.expressions import Expression
from service.grading.comparison import Match, difference
from service.grading.diagnosis.wrong_value import WrongCell, differs, undefined
from service.grading.feedback import Finding
from service.grading.formula_text import sum_text
from service.grading.joint_motion import coefficients
from service.grading.judging.table import JudgedRow, Judgement
from service.grading.judging.table_matches import column_scales
from service.grading.part import Grading
from service.grading.reading.table import IS_ANGLE, HandedInRow
from service.grading.tolerances import ROUNDED_VALUE
from service.kinematics.chain import COLUMNS
from service.kinematics.transforms import Numbers

AXES = {
    "a": "along x",
    "alpha": "about x",
    "d": "along z",
    "theta": "about z",
}
SUM_COUNTS = (
    "The axis is parallel to its neighbour, so it is the sum of the offsets along it that counts."
)
SYMBOLS = {"a": "a", "alpha": "α", "d": "d", "theta": "θ"}


def joint_variable_missing(case: WrongCell) -> Finding | None:
    """The table was taken to describe the drawn pose, so the joint variable was left out."""
    if (
        case.joint is None
        or not any(case.expected_coefficients)
        or case.actual_coefficients is None
    ):
        return None
    if any(case.actual_coefficients):
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
        f"turn or slide {AXES[case.column]} by the right-hand rule.",
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
    own = case.joints.index(case.joint)
    counts = case.actual_coefficients
    if counts[own] or sum(map(abs, counts)) != 1:
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
    own = case.joints.index(case.joint)
    count = case.actual_coefficients[own]
    if not case.expected_coefficients[own] or abs(count) < 2 or _others(case, own):
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
    own = case.joints.index(case.joint)
    if not case.actual_coefficients[own] or _others(case, own):
        return None
    kind = "slides, so its variable is d" if case.joint.prismatic else "turns, so its variable is θ"
    return Finding(
        "joint_variable_column",
        f"Joint {case.joint.index} {kind}; {SYMBOLS[case.column]} is constant here.",
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
        f"{' and '.join(extra)} must not be in this cell: it does not change "
        f"{SYMBOLS[case.column]} of this row.",
        case.correction,
    )


def sign(case: WrongCell) -> Finding | None:
    """The size is right, the direction is not."""
    if not case.same_motion:
        return None
    actual, expected = case.constants
    if not case.equal(actual, -expected):
        return None
    what = "turn" if case.angle else "distance"
    return Finding(
        "sign",
        f"The sign of {SYMBOLS[case.column]} is wrong: measure the {what} {AXES[case.column]}, "
        f"positive in the direction of that axis.",
        case.correction,
    )


def distance_left_out(case: WrongCell) -> Finding | None:
    """A distance between the frames was overlooked."""
    if case.angle or not case.same_motion:
        return None
    actual, expected = case.constants
    if not case.equal(actual, 0 * actual) or case.equal(expected, 0 * expected):
        return None
    beside = " beside the joint variable" if any(case.expected_coefficients) else ""
    return Finding(
        "distance_left_out",
        f"A distance is left out of {SYMBOLS[case.column]}{beside}: these two frames are apart "
        f"{AXES[case.column]}.",
        case.correction,
    )


def distance_extra(case: WrongCell) -> Finding | None:
    """A distance was put where there is none: into the wrong cell, or counted twice."""
    if case.angle or not case.same_motion:
        return None
    actual, expected = case.constants
    if not case.equal(expected, 0 * expected) or case.equal(actual, 0 * actual):
        return None
    beside = " beside the joint variable" if any(case.expected_coefficients) else ""
    return Finding(
        "distance_extra",
        f"There is no distance {AXES[case.column]} here{beside}: look along which axis of which "
        f"frame it is measured.",
        case.correction,
    )


def degrees_as_radians(case: WrongCell) -> Finding | None:
    """A number meant in degrees was handed in where radians are read."""
    if not case.angle or not case.same_motion:
        return None
    actual, expected = case.constants
    meant = np.radians(actual)
    turned = case.equal(meant, -expected)
    if not (case.equal(meant, expected) or turned):
        return None
    return Finding(
        "degrees_as_radians",
        "This number was read in radians, but it fits in degrees: write the unit (90deg or "
        f"90°), or write it with pi.{' Its sign is wrong, too.' if turned else ''}",
        case.correction,
    )


def radians_as_degrees(case: WrongCell) -> Finding | None:
    """A number meant in radians was handed in where degrees are read."""
    if not case.angle or not case.same_motion:
        return None
    actual, expected = case.constants
    if not case.equal(np.degrees(actual), expected):
        return None
    return Finding(
        "radians_as_degrees",
        "This number was read in degrees, but it fits in radians: write it with pi, or in degrees.",
        case.correction,
    )


def quarter_turn(case: WrongCell) -> Finding | None:
    """A turn by 90° was left out, added, or made the wrong way from a quarter to three quarters."""
    if not case.angle or not case.same_motion:
        return None
    actual, expected = case.constants
    if not any(_is_off_by(turn, actual, expected) for turn in (np.pi / 2, -np.pi / 2)):
        return None
    return Finding(
        "quarter_turn",
        f"{SYMBOLS[case.column]} is off by a quarter turn (90°): compare the two axes that it is "
        f"measured between, in the home configuration.",
        case.correction,
    )


def half_turn(case: WrongCell) -> Finding | None:
    """An axis was taken to point the opposite way."""
    if not case.angle or not case.same_motion:
        return None
    actual, expected = case.constants
    if not _is_off_by(np.pi, actual, expected):
        return None
    return Finding(
        "half_turn",
        f"{SYMBOLS[case.column]} is off by half a turn (180°): check which way the axes point that "
        f"it is measured between.",
        case.correction,
    )


def _is_off_by(turn: float, actual: Numbers, expected: Numbers) -> bool:
    """Whether an angle is expected so much further on; the turn itself may have been rounded."""
    off = difference(actual + turn, expected, angle=True)
    return bool(np.abs(off).max() < ROUNDED_VALUE * np.pi)


MISCONCEPTIONS: tuple[Callable[[WrongCell], Finding | None], ...] = (
    undefined,
    joint_variable_missing,
    joint_variable_sign,
    joint_variable_index,
    joint_variable_doubled,
    joint_variable_column,
    joint_variable_extra,
    sign,
    distance_left_out,
    distance_extra,
    degrees_as_radians,
    radians_as_degrees,
    quarter_turn,
    half_turn,
)


def diagnose(case: WrongCell) -> Finding:
    """What to say about a wrong cell: the first misconception that explains it."""
    finding = _first(case)
    if case.column == "d" and case.shared and case.same_motion:
        return replace(finding, hint=f"{finding.hint} {SUM_COUNTS}")
    return finding


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


def _first(case: WrongCell) -> Finding:
    for misconception in MISCONCEPTIONS:
        finding = misconception(case)
        if finding is not None:
            return finding
    return differs(
        case,
        f"{SYMBOLS[case.column]} is not right here: measure the "
        f"{'angle' if case.angle else 'distance'} {AXES[case.column]} again.{_bare(case)}",
    )


def _bare(case: WrongCell) -> str:
    """A hint where a number is far too large for radians."""
    if not case.angle or not case.same_motion or np.abs(case.constants[0]).max() < 3 * np.pi:
        return ""
    return " Its number was read in radians: write the unit (90deg or 90°) if degrees were meant."


def _others(case: WrongCell, own: int) -> bool:
    """Whether the cell contains a variable of another joint."""
    counts = case.actual_coefficients or ()
    return any(count for i, count in enumerate(counts) if i != own)


def _moves(case: WrongCell) -> str:
    return "slides along z" if case.joint and case.joint.prismatic else "turns about z"
