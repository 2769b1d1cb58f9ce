"""Slips in the coordinates of a point."""

from dataclasses import dataclass
from functools import cached_property
from itertools import permutations

import numpy as np

from service.grading.diagnosis.motions.given_motion import GivenMotion
from service.grading.diagnosis.motions.link_products import Chain, named, other_poses
from service.grading.diagnosis.motions.motion_slips import Displacements
from service.grading.diagnosis.upstream.slip_search import AFTER_SIGNS, SlipSearch
from service.grading.diagnosis.wording import UNIT_FACTORS, other_length_unit
from service.grading.diagnosis.wrong_value import Hypotheses, WrongNumbers
from service.grading.misconception import (
    Explained,
    Written,
    check,
    explanation,
    misconception,
    says,
)
from service.grading.numerics.tolerances import EXACT_VALUE
from service.translations import say, template


@dataclass(frozen=True)
class WrongPosition(WrongNumbers):
    """Wrong coordinates of a point: n values at each sample, ``(n, SAMPLES)``."""

    # The axes of the coordinates: 0, 1 or 2.
    axes: tuple[int, ...]
    # The links whose end is the point, if it is the end of a chain of links.
    chains: tuple[Chain, ...] = ()
    # Compares the point with the wrong answers that mistakes in the table lead to.
    slips: SlipSearch | None = None
    # The displacements in the formulas of the exercise.
    motion: GivenMotion | None = None

    @cached_property
    def slip(self) -> Explained | None:
        """The mistake in the table that explains all coordinates, or None."""
        every = np.ones(len(self.axes), dtype=np.bool_)
        return None if self.slips is None else self.slips.explanation(every)


@misconception(
    of=WrongPosition,
    rank=10,
    code="exchanged_coordinates",
    rule="position_vector",
    means="the coordinates are right, but in the wrong order",
    example=("planar-rr", "position", "[a1 s1 + a2 s12, a1 c1 + a2 c12]"),
    unlike="[a1 s1 - a2 s12, a1 c1 + a2 c12]",
)
def exchanged_coordinates(case: WrongPosition) -> Hypotheses:
    """The coordinates are correct, but in the wrong order."""
    names = ", ".join("xyz"[axis] for axis in case.axes)
    finding = says(
        say("These coordinates are in the wrong order: it must be {order}.", order=names)
    )
    for order in permutations(range(len(case.axes))):
        yield Written(case.expected[list(order)], finding)


@check(of=WrongPosition, rank=20)
def slip(case: WrongPosition) -> Explained | None:
    """A likely mistake in the table explains the position."""
    # It is likelier than a reversed position.
    found = case.slip
    return None if found is None or found.findings[0].code in AFTER_SIGNS else found


@misconception(
    of=WrongPosition,
    rank=30,
    code="reversed_position",
    rule="position_vector",
    means="all signs are wrong: the vector leads from the point to the origin",
    example=("planar-rr", "position", "[-a1 c1 - a2 c12, -a1 s1 - a2 s12]"),
    unlike="[a1 c1 + a2 c12, -a1 s1 - a2 s12]",
)
def reversed_position(case: WrongPosition) -> Hypotheses:
    """All signs are wrong: the vector leads from the point to the origin."""
    finding = says(
        say("Every coordinate has the wrong sign: check where the vector must start and end."),
    )
    yield Written(-case.expected, finding)


@check(of=WrongPosition, rank=40)
def slip_after_signs(case: WrongPosition) -> Explained | None:
    """A less likely mistake in the table explains the position."""
    # It is less likely than a reversed position.
    return case.slip


@misconception(
    of=WrongPosition,
    rank=45,
    code="other_length_unit",
    rule="position_vector",
    means=template("all lengths are in another unit, such as millimetres instead of metres"),
    example=("planar-rr", "position", "[1000*(a1 c1 + a2 c12), 1000*(a1 s1 + a2 s12)]"),
    unlike="[1000*(a1 c1 - a2 c12), 1000*(a1 s1 - a2 s12)]",
)
def length_unit(case: WrongPosition) -> Hypotheses:
    """The coordinates are in a wrong unit of length."""
    for times in UNIT_FACTORS:
        yield Written(times * case.expected, other_length_unit(times))


@misconception(of=WrongPosition, rank=50)
def other_pose(case: WrongPosition) -> Hypotheses:
    """The position is that of a wrong pose, such as the pose of a wrong frame."""
    # A constant position, such as the origin itself, does not show which pose it belongs to.
    for pose in other_poses(case.chains):
        position = np.moveaxis(pose.answer, 0, -1)[list(case.axes), 3]
        if np.ptp(position, axis=-1).max() > EXACT_VALUE:
            # Translators: {pose} is a name such as "the pose of frame {2}".
            found = named(pose, template("This position comes from {pose}. {advice}"))
            yield Written(position, found, record=pose.record)


@check(of=WrongPosition, rank=60)
def displacement(case: WrongPosition) -> Explained | None:
    """The correct position is a sum of displacements, and the student added them wrongly."""
    return None if case.motion is None else explanation(case, case.motion, Displacements)
