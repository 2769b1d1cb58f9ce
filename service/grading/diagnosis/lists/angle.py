"""Slips in a single angle."""

import numpy as np

from service.expressions.tree import Call, Node
from service.grading.diagnosis.formulas.formula_rewriting import nodes
from service.grading.diagnosis.lists.angle_sum import WrongSum
from service.grading.diagnosis.wrong_value import (
    UNEXPLAINED,
    Hypotheses,
    WrongValue,
    differs,
    finding_on,
)
from service.grading.feedback import Finding
from service.grading.misconception import (
    Explained,
    Repaired,
    Written,
    check,
    diagnosed,
    explanation,
    misconception,
)
from service.grading.numerics.comparison import difference
from service.grading.numerics.tolerances import CONSTANT, ROUNDED_VALUE
from service.kinematics.transforms import Numbers
from service.translations import say

WRONG_SIGN = say(
    "The sign of this angle is wrong: an angle counts positive by the right-hand rule about its "
    "axis."
)
FITS_IN_DEGREES = say(
    "This angle was read in radians, but it fits in degrees: write the unit behind it (deg or °)."
)
FITS_IN_RADIANS = say(
    "This angle was read in degrees, but it fits in radians: write the unit behind it (rad)."
)
CONVERTED = say(
    "This angle was converted between degrees and radians. Leave out the factor: a joint variable "
    "and a function such as atan2 already give the angle."
)
ARGUMENTS_SWAPPED = say(
    "The arguments of atan2 are exchanged: in atan2(y, x) the part of the sine comes first, that "
    "of the cosine second."
)
NOT_RIGHT = say("This angle is not right: check which two directions it is measured between.")


class WrongAngle(WrongValue):
    """A wrong angle; misconceptions about angles are registered under this class."""


@misconception(
    of=WrongAngle,
    rank=100,
    code="sign",
    rule="elementary_turn",
    means="the sign of an angle is wrong",
    example=("spherical-wrist", "zyz", "[-theta4, theta5, theta6]"),
    unlike="[theta4, theta5, theta6 + 1]",
)
def sign(case: WrongValue) -> Hypotheses:
    """The angle has the wrong sign."""
    yield Written(-case.expected, finding_on(case, WRONG_SIGN))


@misconception(
    of=WrongAngle,
    rank=110,
    code="degrees_as_radians",
    rule="angle_unit",
    means="a number of degrees is read in radians, or a variable is multiplied by 180/π",
    example=("spherical-wrist", "zyz", "[180*theta4/pi, theta5]"),
    unlike={"2/1": "0"},
)
def degrees_as_radians(case: WrongValue) -> Hypotheses:
    """The angle was written in degrees, but is read in radians."""
    hint = FITS_IN_DEGREES if is_constant(case.actual) else CONVERTED
    yield Repaired(np.radians(case.actual), finding_on(case, hint))


@misconception(
    of=WrongAngle,
    rank=120,
    code="radians_as_degrees",
    rule="angle_unit",
    means="a number of radians is read in degrees, or a variable is multiplied by π/180",
    example=("spherical-wrist", "zyz", "[pi*theta4/180, theta5]"),
    unlike={"2/1": "0"},
)
def radians_as_degrees(case: WrongValue) -> Hypotheses:
    """The angle was written in radians, but is read in degrees."""
    hint = FITS_IN_RADIANS if is_constant(case.actual) else CONVERTED
    yield Repaired(np.degrees(case.actual), finding_on(case, hint))


def is_constant(angle: Numbers) -> bool:
    """True if an angle ``(SAMPLES,)`` is a constant."""
    return bool(np.ptp(angle) < CONSTANT)


@misconception(
    of=WrongAngle,
    rank=130,
    code="lost_quadrant",
    rule="atan2",
    means="atan, acos or asin is used for atan2, so the angle is right only for some joint values",
    example=("spherical-wrist", "zyz", "[atan(s4/c4), theta5, theta6]"),
    unlike={"3/1": "theta6/2"},
)
def lost_quadrant(case: WrongValue) -> Hypotheses:
    """The student used atan(y/x) instead of atan2(y, x)."""
    opposite = np.abs(difference(case.actual, case.expected, angle=True)) > np.pi / 2
    if opposite.any() and not opposite.all():
        finding = finding_on(
            case,
            say(
                "This angle is right for some joint values only: atan(y/x) gives one angle for two "
                "opposite directions. Use atan2(y, x)."
            ),
        )
        yield Written(case.expected + np.pi * opposite, finding, tolerance=ROUNDED_VALUE)


@misconception(
    of=WrongAngle,
    rank=140,
    code="lost_quadrant",
    rule="atan2",
    means="atan, acos or asin is used for atan2, so the angle is right only for some joint values",
    example=("several-kinds", "angle", "[asin(l*sin(phi)/sqrt(a^2 + l^2 + 2*a*l*cos(phi))), e1]"),
    unlike="[asind(e1), a]",
)
def lost_sign(case: WrongValue) -> Hypotheses:
    """The student used acos or asin instead of atan2."""
    names = {
        "acos": (
            -case.expected,
            say(
                "This angle is right for some joint values only: acos gives no negative angle. "
                "Use atan2(y, x)."
            ),
        ),
        "asin": (
            np.pi - case.expected,
            say(
                "This angle is right for some joint values only: asin gives no angle over 90°. "
                "Use atan2(y, x)."
            ),
        ),
    }
    for function, (other, hint) in names.items():
        if _calls(case.expression.tree, function):
            is_other = np.abs(difference(case.actual, other, angle=True)) < ROUNDED_VALUE
            written = np.where(is_other, other, case.expected)
            yield Written(written, finding_on(case, hint), tolerance=ROUNDED_VALUE)


@misconception(
    of=WrongAngle,
    rank=150,
    code="half_turn",
    rule="atan2",
    means="an angle is off by 180°",
    example=("spherical-wrist", "zyz", "[theta4, theta5, theta6 + pi]"),
    unlike="[theta6, theta5, theta4]",
)
def half_turn(case: WrongValue) -> Hypotheses:
    """The angle differs by half a turn (180°) from the correct angle."""
    finding = finding_on(
        case,
        say(
            "This angle is off by half a turn: check its signs, and in atan2 those of both "
            "arguments."
        ),
        otherwise=say("It is off by half a turn (180°)."),
    )
    yield Written(case.expected + np.pi, finding, tolerance=ROUNDED_VALUE)


@misconception(
    of=WrongAngle,
    rank=160,
    code="swapped_atan2",
    rule="atan2",
    means="the arguments of atan2 are exchanged",
    example=("spherical-wrist", "zyz", "[atan2(c4, s4), theta5]"),
    unlike={"3/1": "theta6/2"},
)
def swapped_atan2(case: WrongValue) -> Hypotheses:
    """The arguments of atan2 were exchanged."""
    # If the angle is a constant and no arctangent, a wrong quarter turn is more likely.
    if np.ptp(case.expected) > ROUNDED_VALUE or is_arctangent(case.expression.tree):
        yield Written(np.pi / 2 - case.expected, finding_on(case, ARGUMENTS_SWAPPED))


def is_arctangent(tree: Node) -> bool:
    """True if the formula is an arctangent, not only contains one."""
    return isinstance(tree, Call) and tree.function in ("atan2", "atan")


def _calls(tree: Node, *functions: str) -> bool:
    return any(isinstance(node, Call) and node.function in functions for node in nodes(tree))


@misconception(
    of=WrongAngle,
    rank=170,
    code="quarter_turn",
    rule="elementary_turn",
    means="an angle is off by 90°",
    example=("spherical-wrist", "zyz", "[theta4, theta5, theta6 + pi/2]"),
    unlike="[theta4, theta5, theta6 + pi]",
)
def quarter_turn(case: WrongValue) -> Hypotheses:
    """The angle differs by 90° from the correct angle."""
    finding = finding_on(case, NOT_RIGHT, otherwise=say("It is off by a quarter turn (90°)."))
    error = difference(case.actual, case.expected, angle=True)
    yield Written(case.expected + np.copysign(np.pi / 2, error), finding, tolerance=ROUNDED_VALUE)


@check(of=WrongAngle, rank=200)
def of_sum(case: WrongValue) -> Explained | None:
    """The correct angle is a sum, and the student made a mistake in this sum."""
    return explanation(case, WrongSum.of(case))


@check(
    of=WrongAngle,
    rank=300,
    code=UNEXPLAINED,
    rule="euler_sequence",
    means="the value is wrong, and no other code explains it",
    example=("spherical-wrist", "zyz", "[theta4, theta5, theta6 + 1]"),
    unlike="[theta4, theta5, theta6 + pi]",
)
def unexplained(case: WrongValue) -> Finding:
    """No misconception explains the angle."""
    return differs(case, NOT_RIGHT)


def diagnose_angle(case: WrongValue) -> Finding:
    """Return the finding on a wrong angle."""
    finding = diagnosed(case, of=WrongAngle)
    assert finding is not None
    return finding
