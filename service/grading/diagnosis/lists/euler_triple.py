"""Slips in the three Euler angles of a rotation."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from service.grading.diagnosis.lists import angle
from service.grading.feedback import Finding
from service.grading.misconception import (
    AnyHypothesis,
    Explained,
    Repaired,
    explanation,
    misconception,
    says,
)
from service.grading.numerics.tolerances import ROUNDED_VALUE
from service.kinematics.rotations import SEQUENCES, from_angles
from service.kinematics.transforms import Matrices, Numbers
from service.translations import Sentence, say


@dataclass(frozen=True)
class WrongTriple:
    """Three angles that do not describe the correct rotation."""

    # (3, SAMPLES), with a value everywhere.
    angles: Numbers
    # The correct rotation, (SAMPLES, 3, 3).
    rotation: Matrices
    # The names of the axes, such as ZYZ.
    sequence: str
    # True for fixed axes, False for moving axes.
    fixed: bool
    # Which angles were written with an arctangent.
    arctangents: Sequence[bool] = (False, False, False)

    @property
    def is_right(self) -> bool:
        """True if the angles describe the correct rotation."""
        described = from_angles(self.sequence, self.angles.T, fixed=self.fixed)
        return bool(np.abs(described - self.rotation).max() < ROUNDED_VALUE)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Yield the misconceptions that explain the three angles."""
        return (hypothesis for hypothesis in hypotheses if hypothesis.answer.is_right)


RepairedTriple = Repaired[WrongTriple]


@misconception(
    of=WrongTriple,
    rank=10,
    code=("sign", "degrees_as_radians", "radians_as_degrees", "swapped_atan2"),
    rule="euler_sequence",
    means=(
        "one or more angles have the wrong sign",
        "one or more angles are in degrees, but are read in radians",
        "one or more angles are in radians, but are read in degrees",
        "the arguments of atan2 are exchanged in one or more angles",
    ),
    example=("spherical-wrist", "zyz", "[atan2(c4, s4), theta5, theta6]"),
    unlike="[theta4, theta5, theta6 + 1]",
)
def some_angles(case: WrongTriple) -> Iterator[RepairedTriple]:
    """One or more of the three angles have the same mistake."""
    angles = case.angles
    repairs = (
        (-angles, Finding("sign", angle.WRONG_SIGN, say("Change its sign."))),
        (np.radians(angles), Finding("degrees_as_radians", angle.FITS_IN_DEGREES)),
        (np.degrees(angles), Finding("radians_as_degrees", angle.FITS_IN_RADIANS)),
        (
            np.pi / 2 - angles,
            Finding("swapped_atan2", angle.ARGUMENTS_SWAPPED, say("Exchange them.")),
        ),
    )
    may_be_swapped = (np.ptp(angles, axis=1) > ROUNDED_VALUE) | np.array(case.arctangents)
    for count in (1, 2, 3):
        for repaired, finding in repairs:
            for subset in combinations(range(3), count):
                slipped = np.isin(np.arange(3), subset)
                if finding.code == "swapped_atan2" and not may_be_swapped[slipped].all():
                    continue
                mixed = np.where(slipped[:, None], repaired, angles)
                worded = _on_angles(finding, angles[slipped])
                yield Repaired(replace(case, angles=mixed), worded, slipped)


def _on_angles(finding: Finding, angles: Numbers) -> Finding:
    # A hint on the unit of angles that vary is reworded.
    is_of_unit = finding.hint in (angle.FITS_IN_DEGREES, angle.FITS_IN_RADIANS)
    if is_of_unit and not all(map(angle.is_constant, angles)):
        return replace(finding, hint=angle.CONVERTED)
    return finding


@misconception(
    of=WrongTriple,
    rank=20,
    code="angle_order",
    rule="euler_sequence",
    means="the angles are right, but in the wrong order",
    example=("spherical-wrist", "zyz", "[theta6, theta5, theta4]"),
    unlike={"1/1": "theta5"},
)
def other_order(case: WrongTriple) -> Iterator[RepairedTriple]:
    """The angles are correct, but in the wrong order."""
    finding = says(
        say(
            "These angles are right, but in another order: the first angle is that of the first "
            "axis of the sequence."
        ),
        say("The order here is that of the axes {sequence}.", sequence=case.sequence),
    )
    for order in ([2, 1, 0], [1, 0, 2], [0, 2, 1], [1, 2, 0], [2, 0, 1]):
        yield Repaired(replace(case, angles=case.angles[order]), finding)


@misconception(
    of=WrongTriple,
    rank=30,
    code="inverse_rotation",
    rule="inverse",
    means="the angles describe the inverse rotation",
    example=("spherical-wrist", "zyz", "[-theta6, -theta5, -theta4]"),
    unlike={"1/1": "theta5"},
)
def inverse_rotation(case: WrongTriple) -> Iterator[RepairedTriple]:
    """The angles describe the inverse rotation."""
    finding = says(
        say("These angles describe the inverse rotation: the first frame as seen from the last."),
        say("Take them from the matrix whose columns are the axes of the last frame."),
    )
    yield Repaired(replace(case, rotation=np.swapaxes(case.rotation, 1, 2)), finding)


@misconception(
    of=WrongTriple,
    rank=40,
    code="other_euler_sequence",
    rule="euler_sequence",
    means="the angles belong to another sequence of axes, or to fixed instead of moving axes",
    example=("spherical-wrist", "zyz", "[theta4 + pi/2, theta5, theta6 - pi/2]"),
    unlike={"3/1": "theta6/2"},
)
def other_sequence(case: WrongTriple) -> Iterator[RepairedTriple]:
    """The angles belong to another sequence of axes, or to fixed instead of moving axes."""
    others = sorted(
        ((sequence, fixed) for sequence in SEQUENCES for fixed in (False, True)),
        key=lambda other: (other[0] != case.sequence, other[1] != case.fixed),
    )
    asked = _asked_for(case.sequence, fixed=case.fixed)
    for sequence, fixed in others:
        finding = says(
            _of_another_sequence(sequence, fixed=fixed),
            asked,
        )
        yield Repaired(replace(case, sequence=sequence, fixed=fixed), finding)


def _of_another_sequence(sequence: str, *, fixed: bool) -> Sentence:
    if fixed:
        return say(
            "These are the right angles of another sequence: {sequence} about fixed axes.",
            sequence=sequence,
        )
    return say(
        "These are the right angles of another sequence: {sequence} about moving axes.",
        sequence=sequence,
    )


def _asked_for(sequence: str, *, fixed: bool) -> Sentence:
    if fixed:
        return say("Asked for are those of {sequence} about fixed axes.", sequence=sequence)
    return say("Asked for are those of {sequence} about moving axes.", sequence=sequence)


def explain_triple(case: WrongTriple) -> Explained | None:
    """Return the misconception that explains the three angles, or None."""
    # The entries of the result are the angles that have the slip.
    return None if case.is_right else explanation(case)
