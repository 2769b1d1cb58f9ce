"""Slips in angles: in a single one, and in three that describe a rotation.

Each function is one misconception that the student may have held. It returns what to say where the
answer without that misconception is right, else None.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from service.expressions.tree import Call
from service.grading.comparison import difference
from service.grading.diagnosis.formula_rewriting import nodes
from service.grading.diagnosis.wrong_value import WrongValue, differs, undefined
from service.grading.feedback import Finding
from service.grading.tolerances import ROUNDED_VALUE
from service.kinematics.rotations import SEQUENCES, from_angles
from service.kinematics.transforms import Matrices, Numbers

ARCTANGENTS = ("atan2", "atan")


def sign(case: WrongValue) -> Finding | None:
    """The size is right, the direction is not."""
    if not case.equal(case.actual, -case.expected):
        return None
    return Finding("sign", SIGN, case.correction)


SIGN = "The sign of this angle is wrong: it counts positive by the right-hand rule about its axis."


def degrees_as_radians(case: WrongValue) -> Finding | None:
    """A number meant in degrees was handed in where radians are read."""
    if not case.equal(np.radians(case.actual), case.expected):
        return None
    return Finding("degrees_as_radians", IN_DEGREES, case.correction)


IN_DEGREES = (
    "This angle was read in radians, but it fits in degrees: write the unit (90deg or 90°), or "
    "write it with pi."
)


def radians_as_degrees(case: WrongValue) -> Finding | None:
    """A number meant in radians was handed in where degrees are read."""
    if not case.equal(np.degrees(case.actual), case.expected):
        return None
    return Finding("radians_as_degrees", IN_RADIANS, case.correction)


IN_RADIANS = (
    "This angle was read in degrees, but it fits in radians: write it with pi, or in degrees."
)


def swapped_atan2(case: WrongValue) -> Finding | None:
    """The arguments of atan2 were exchanged, which takes the angle from a quarter turn.

    A constant that is off so is rather off by a quarter turn, unless an atan2 was written.
    """
    varies = np.ptp(case.expected) > ROUNDED_VALUE
    if not (varies or _has_arctangent(case)):
        return None
    if not case.equal(case.actual, np.pi / 2 - case.expected):
        return None
    return Finding("swapped_atan2", SWAPPED, case.correction)


SWAPPED = (
    "The arguments of atan2 seem to be exchanged: atan2(y, x) takes the sine's part first, then "
    "the cosine's."
)


def _has_arctangent(case: WrongValue) -> bool:
    return any(
        isinstance(node, Call) and node.function in ARCTANGENTS
        for node in nodes(case.expression.tree)
    )


def lost_quadrant(case: WrongValue) -> Finding | None:
    """atan(y/x) was taken for atan2(y, x): it is half a turn off where x is negative."""
    off = np.abs(difference(case.actual, case.expected, angle=True))
    half = np.abs(off - np.pi) < ROUNDED_VALUE
    if half.all() or not half.any() or not ((off < ROUNDED_VALUE) | half).all():
        return None
    return Finding(
        "lost_quadrant",
        "This angle is right for some joint values and half a turn off for others: atan(y/x) "
        "cannot tell opposite directions apart, atan2(y, x) can.",
        case.correction,
    )


def quarter_turn(case: WrongValue) -> Finding | None:
    """A turn by 90° was left out or added."""
    off = np.abs(difference(case.actual, case.expected, angle=True))
    if np.abs(off - np.pi / 2).max() > ROUNDED_VALUE:
        return None
    return Finding("quarter_turn", "This angle is off by a quarter turn (90°).", case.correction)


def half_turn(case: WrongValue) -> Finding | None:
    """A direction was taken for its opposite."""
    off = np.abs(difference(case.actual, case.expected, angle=True))
    if np.abs(off - np.pi).max() > ROUNDED_VALUE:
        return None
    return Finding(
        "half_turn",
        "This angle is off by half a turn (180°): the direction that it is measured to is the "
        "opposite one.",
        case.correction,
    )


MISCONCEPTIONS: tuple[Callable[[WrongValue], Finding | None], ...] = (
    undefined,
    sign,
    degrees_as_radians,
    radians_as_degrees,
    lost_quadrant,
    half_turn,
    swapped_atan2,
    quarter_turn,
)


def diagnose_angle(case: WrongValue) -> Finding:
    """What to say about a wrong angle: the first misconception that explains it."""
    for misconception in MISCONCEPTIONS:
        finding = misconception(case)
        if finding is not None:
            return finding
    return differs(case, "This angle is not right; work it out again.")


# --- three angles


@dataclass(frozen=True)
class WrongAngles:
    """Three angles that do not describe the rotation they should.

    ``angles`` is ``(3, SAMPLES)``, all of them with a value everywhere; ``rotation`` is what they
    should describe, ``(SAMPLES, 3, 3)``, in ``sequence`` about moving or ``fixed`` axes.
    ``arctangent`` says which angles were written with an arctangent.
    """

    angles: Numbers
    rotation: Matrices
    sequence: str
    fixed: bool
    arctangent: tuple[bool, bool, bool] = (False, False, False)

    @property
    def described(self) -> Matrices:
        """The rotation that they do describe, ``(SAMPLES, 3, 3)``."""
        return from_angles(self.sequence, self.angles.T, fixed=self.fixed)

    @property
    def right(self) -> bool:
        """Whether that is the rotation that they should."""
        return bool(np.abs(self.described - self.rotation).max() < ROUNDED_VALUE)


@dataclass(frozen=True, slots=True)
class AnglesExplained:
    """What is wrong, of the angles marked in ``blamed`` ``(3,)`` alone or else of all together."""

    finding: Finding
    blamed: NDArray[np.bool_] | None = None


def other_order(case: WrongAngles) -> AnglesExplained | None:
    """The angles were written down from last to first."""
    if not replace(case, angles=case.angles[::-1]).right:
        return None
    return AnglesExplained(
        Finding(
            "angle_order",
            "These angles are right, but in the opposite order.",
            f"The order here is that of the axes {case.sequence}.",
        )
    )


def other_sequence(case: WrongAngles) -> AnglesExplained | None:
    """The angles are those of another sequence of axes, or of fixed axes for moving ones."""
    others = sorted(
        ((name, fixed) for name in SEQUENCES for fixed in (False, True)),
        key=lambda other: (other[0] != case.sequence, other[1] != case.fixed),
    )
    for name, fixed in others:
        if replace(case, sequence=name, fixed=fixed).right:
            return AnglesExplained(
                Finding(
                    "other_euler_sequence",
                    f"These are the right angles of another sequence: {_named(name, fixed)}.",
                    f"Asked for are those of {_named(case.sequence, case.fixed)}.",
                )
            )
    return None


def _named(sequence: str, fixed: bool) -> str:
    return f"{sequence} about {'fixed' if fixed else 'moving'} axes"


def inverse_rotation(case: WrongAngles) -> AnglesExplained | None:
    """The angles lead back: they describe the first frame as seen from the last."""
    if not replace(case, rotation=np.swapaxes(case.rotation, 1, 2)).right:
        return None
    return AnglesExplained(
        Finding(
            "inverse_rotation",
            "These angles describe the inverse rotation, that of the first frame in the last.",
            "Take them from the matrix whose columns are the axes of the last frame.",
        )
    )


def some_angles(case: WrongAngles) -> AnglesExplained | None:
    """One and the same slip in one, two or all three of the angles."""
    for count in (1, 2, 3):
        for finding, repaired in _repairs(case):
            for chosen in combinations(range(3), count):
                if finding.code == "swapped_atan2" and not _may_be_swapped(case, chosen):
                    continue
                angles = case.angles.copy()
                angles[list(chosen)] = repaired[list(chosen)]
                if replace(case, angles=angles).right:
                    blamed = np.isin(np.arange(3), chosen)
                    return AnglesExplained(finding, blamed)
    return None


def _repairs(case: WrongAngles) -> Iterator[tuple[Finding, Numbers]]:
    yield Finding("sign", SIGN, "Change its sign."), -case.angles
    yield Finding("degrees_as_radians", IN_DEGREES), np.radians(case.angles)
    yield Finding("radians_as_degrees", IN_RADIANS), np.degrees(case.angles)
    yield Finding("swapped_atan2", SWAPPED, "Exchange them."), np.pi / 2 - case.angles


def _may_be_swapped(case: WrongAngles, chosen: Sequence[int]) -> bool:
    return all(case.arctangent[i] or np.ptp(case.angles[i]) > ROUNDED_VALUE for i in chosen)


TRIPLES: tuple[Callable[[WrongAngles], AnglesExplained | None], ...] = (
    some_angles,
    other_order,
    inverse_rotation,
    other_sequence,
)


def explain_angles(case: WrongAngles) -> AnglesExplained | None:
    """The first misconception that explains the three angles together."""
    if case.right:
        return None
    return next(
        (found for misconception in TRIPLES if (found := misconception(case)) is not None), None
    )
