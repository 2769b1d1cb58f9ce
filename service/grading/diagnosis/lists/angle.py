"""Slips in a single angle."""

import numpy as np

from service.expressions.tree import Call, Node
from service.grading.diagnosis.formulas.formula_rewriting import nodes
from service.grading.diagnosis.lists.angle_sum import BETWEEN, explain_sum
from service.grading.diagnosis.wrong_value import (
    Hypotheses,
    WrongValue,
    differs,
    finding_on,
    undefined,
)
from service.grading.feedback import Finding
from service.grading.misconception import Repaired, Written, diagnosed
from service.grading.numerics.comparison import difference
from service.grading.numerics.tolerances import CONSTANT, ROUNDED_VALUE
from service.kinematics.transforms import Numbers

WRONG_SIGN = (
    "The sign of this angle is wrong: an angle counts positive by the right-hand rule about its "
    "axis."
)
FITS_IN_DEGREES = (
    "This angle was read in radians, but it fits in degrees: write the unit behind it (deg or °)."
)
FITS_IN_RADIANS = (
    "This angle was read in degrees, but it fits in radians: write the unit behind it (rad)."
)
CONVERTED = (
    "This angle was converted between degrees and radians. Leave out the factor: a joint variable "
    "and a function such as atan2 already give the angle."
)
ARGUMENTS_SWAPPED = (
    "The arguments of atan2 are exchanged: in atan2(y, x) the part of the sine comes first, that "
    "of the cosine second."
)


def sign(case: WrongValue) -> Hypotheses:
    """The size is right, the direction is not."""
    yield Written(-case.expected, finding_on(case, "sign", WRONG_SIGN))


def degrees_as_radians(case: WrongValue) -> Hypotheses:
    """An angle in degrees was handed in where radians are read."""
    hint = FITS_IN_DEGREES if is_constant(case.actual) else CONVERTED
    yield Repaired(np.radians(case.actual), finding_on(case, "degrees_as_radians", hint))


def radians_as_degrees(case: WrongValue) -> Hypotheses:
    """An angle in radians was handed in where degrees are read."""
    hint = FITS_IN_RADIANS if is_constant(case.actual) else CONVERTED
    yield Repaired(np.degrees(case.actual), finding_on(case, "radians_as_degrees", hint))


def is_constant(angle: Numbers) -> bool:
    """Whether an angle ``(SAMPLES,)`` is a number; a formula in the wrong unit has a factor."""
    return bool(np.ptp(angle) < CONSTANT)


def lost_quadrant(case: WrongValue) -> Hypotheses:
    """atan(y/x) was taken for atan2(y, x), which differs by half a turn where x is negative."""
    opposite = np.abs(difference(case.actual, case.expected, angle=True)) > np.pi / 2
    if opposite.any() and not opposite.all():
        finding = finding_on(
            case,
            "lost_quadrant",
            "This angle is right for some joint values only: atan(y/x) gives one angle for two "
            "opposite directions. Use atan2(y, x).",
        )
        yield Written(case.expected + np.pi * opposite, finding, tolerance=ROUNDED_VALUE)


def lost_sign(case: WrongValue) -> Hypotheses:
    """Acos or asin gave the angle, which is right for one half of all directions."""
    names = {
        "acos": (-case.expected, "acos gives no negative angle"),
        "asin": (np.pi - case.expected, "asin gives no angle over 90°"),
    }
    for function, (other, reason) in names.items():
        if _calls(case.expression.tree, function):
            is_other = np.abs(difference(case.actual, other, angle=True)) < ROUNDED_VALUE
            finding = finding_on(
                case,
                "lost_quadrant",
                f"This angle is right for some joint values only: {reason}. Use atan2(y, x).",
            )
            written = np.where(is_other, other, case.expected)
            yield Written(written, finding, tolerance=ROUNDED_VALUE)


def half_turn(case: WrongValue) -> Hypotheses:
    """A direction was taken for its opposite."""
    finding = finding_on(
        case,
        "half_turn",
        "This angle is off by half a turn: check its signs, and in atan2 those of both arguments.",
        otherwise="It is off by half a turn (180°).",
    )
    yield Written(case.expected + np.pi, finding, tolerance=ROUNDED_VALUE)


def swapped_atan2(case: WrongValue) -> Hypotheses:
    """The arguments of atan2 were exchanged, which takes the angle from a quarter turn.

    Without an arctangent, a constant is more likely to lack a quarter turn.
    """
    if np.ptp(case.expected) > ROUNDED_VALUE or has_arctangent(case.expression.tree):
        yield Written(
            np.pi / 2 - case.expected, finding_on(case, "swapped_atan2", ARGUMENTS_SWAPPED)
        )


def has_arctangent(tree: Node) -> bool:
    """Whether an arctangent was written."""
    return _calls(tree, "atan2", "atan")


def _calls(tree: Node, *functions: str) -> bool:
    return any(isinstance(node, Call) and node.function in functions for node in nodes(tree))


def quarter_turn(case: WrongValue) -> Hypotheses:
    """A turn by 90° was left out or added."""
    finding = finding_on(
        case,
        "quarter_turn",
        f"This angle is not right: {BETWEEN}",
        otherwise="It is off by a quarter turn (90°).",
    )
    error = difference(case.actual, case.expected, angle=True)
    yield Written(case.expected + np.copysign(np.pi / 2, error), finding, tolerance=ROUNDED_VALUE)


CHECKS = (undefined,)
OF_UNIT = (degrees_as_radians, radians_as_degrees)
OF_TURNS = (lost_quadrant, lost_sign, half_turn, swapped_atan2, quarter_turn)
MISCONCEPTIONS = (sign, *OF_UNIT, *OF_TURNS)


def diagnose_angle(case: WrongValue) -> Finding:
    """The finding on a wrong angle."""
    found = diagnosed(case, MISCONCEPTIONS, CHECKS) or explain_sum(case)
    return found or differs(case, f"This angle is not right: {BETWEEN}")
