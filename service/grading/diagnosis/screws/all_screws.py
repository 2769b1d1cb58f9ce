"""Slips in the screw axes of all joints."""

from dataclasses import dataclass

import numpy as np

from service.grading.diagnosis.screws.screw_axis import (
    AXIS_REVERSED,
    EXCHANGED_HALVES,
    MOMENT_SIGN,
    WrongScrew,
    seen_from_elsewhere,
)
from service.grading.diagnosis.wrong_value import Hypotheses, Mask, WrongNumbers
from service.grading.feedback import Finding
from service.grading.misconception import Written, diagnosed, misconception
from service.kinematics.transforms import Numbers


@dataclass(frozen=True)
class WrongScrews(WrongNumbers):
    """The screw axes in a wrong answer, and the expected axes: ``(joints, 6, SAMPLES)`` each."""

    # The wrong numbers, (joints, 6).
    wrong: Mask
    # The correct axes in the other frame, or None if they are unknown.
    elsewhere: Numbers | None
    # The frame that is asked for: "space" or "body".
    frame: str

    @property
    def several(self) -> bool:
        """True if two or more axes are wrong."""
        return int(self.wrong.any(axis=1).sum()) > 1

    @property
    def axes(self) -> list[WrongScrew]:
        """A ``WrongScrew`` for each axis."""
        return [self.axis(i) for i in range(len(self.expected))]

    def axis(self, i: int) -> WrongScrew:
        """Return the ``WrongScrew`` of axis ``i``."""
        elsewhere = None if self.elsewhere is None else self.elsewhere[i]
        return WrongScrew(self.actual[i], self.expected[i], self.scale, elsewhere, self.frame)


@misconception(
    of=WrongScrews,
    rank=10,
    code="exchanged_halves",
    rule="screw_axis",
    means="the axis is written as (v; ω) instead of (ω; v)",
    example=("simple-twist", "infinite-pitch", "1, 0, 0, 0, 0, 0"),
    unlike={"1/2": "90"},
)
def exchanged_halves(case: WrongScrews) -> Hypotheses:
    """Every axis was written as (v; ω) instead of (ω; v)."""
    yield Written(np.roll(case.expected, 3, axis=1), EXCHANGED_HALVES)


@misconception(
    of=WrongScrews,
    rank=20,
    code="axis_reversed",
    rule="screw_axis",
    when=lambda case: case.several,
    means="the axis points the opposite way, but the exercise asks for one direction",
    example=(
        "planar-rpr-poe",
        "space-screws",
        {"1/3": "-1", "2/4": "-1", "3/3": "-1", "3/5": "L1"},
    ),
    unlike={"1/3": "2"},
)
def axes_reversed(case: WrongScrews) -> Hypotheses:
    """Every axis points the opposite way."""
    yield Written(-case.expected, AXIS_REVERSED)


@misconception(
    of=WrongScrews,
    rank=30,
    code="moment_sign",
    rule="screw_axis",
    when=lambda case: case.several,
    means="v is ω × q instead of −ω × q",
    example=("planar-rpr-poe", "body-screws", {"1/5": "-L1 - L2", "3/5": "-L2"}),
    unlike={"2/4": "0", "2/6": "1"},
)
def moment_signs(case: WrongScrews) -> Hypotheses:
    """The student wrote v = ω × q instead of −ω × q for every turning joint."""
    axes = [
        axis.with_velocity(axis.pitch * axis.direction - axis.moment) if axis.turns else right
        for axis, right in zip(case.axes, case.expected, strict=True)
    ]
    yield Written(np.array(axes), MOMENT_SIGN)


@misconception(
    of=WrongScrews,
    rank=40,
    code=("body_for_space", "space_for_body"),
    rule="screw_axis",
    when=lambda case: case.several,
    means=(
        "the body axis is given for the space axis",
        "the space axis is given for the body axis",
    ),
    example=("planar-rpr-poe", "body-screws", {"1/5": "0", "3/5": "-L1"}),
    unlike={"1/3": "0", "3/5": "0"},
)
def other_frame(case: WrongScrews) -> Hypotheses:
    """Every axis is described in the wrong frame: body for space, or space for body."""
    if case.elsewhere is not None:
        yield Written(case.elsewhere, seen_from_elsewhere(case.frame))


def explain_screws(case: WrongScrews) -> Finding | None:
    """Return the finding that explains all wrong axes, or None."""
    # If only one axis is wrong, only the order of ω and v is checked.
    if not np.isfinite(case.actual).all():
        return None
    return diagnosed(case)
