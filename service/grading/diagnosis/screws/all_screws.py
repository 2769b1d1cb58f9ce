"""Slips that run through the screw axes of all joints."""

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
from service.grading.misconception import Written, diagnosed
from service.kinematics.transforms import Numbers


@dataclass(frozen=True)
class WrongScrews(WrongNumbers):
    """Screw axes that are not the expected ones, ``(joints, 6, SAMPLES)`` each.

    ``wrong`` ``(joints, 6)`` marks the wrong numbers. ``elsewhere`` and ``frame`` are as in
    ``WrongScrew``, ``elsewhere`` of all axes.
    """

    wrong: Mask
    elsewhere: Numbers | None
    frame: str

    @property
    def axes(self) -> list[WrongScrew]:
        """The axes one by one."""
        return [self.axis(i) for i in range(len(self.expected))]

    def axis(self, i: int) -> WrongScrew:
        """Axis ``i`` by itself."""
        elsewhere = None if self.elsewhere is None else self.elsewhere[i]
        return WrongScrew(self.actual[i], self.expected[i], self.scale, elsewhere, self.frame)


def exchanged_halves(case: WrongScrews) -> Hypotheses:
    """Every axis was written as (v; ω)."""
    yield Written(np.roll(case.expected, 3, axis=1), EXCHANGED_HALVES)


def axes_reversed(case: WrongScrews) -> Hypotheses:
    """Every axis was taken to point the opposite way."""
    yield Written(-case.expected, AXIS_REVERSED)


def moment_signs(case: WrongScrews) -> Hypotheses:
    """V was taken to be ω × q for every turning joint."""
    axes = [
        axis.with_velocity(axis.pitch * axis.direction - axis.moment) if axis.turns else right
        for axis, right in zip(case.axes, case.expected, strict=True)
    ]
    yield Written(np.array(axes), MOMENT_SIGN)


def other_frame(case: WrongScrews) -> Hypotheses:
    """Every axis was seen from the tool where the base is asked for, or the other way."""
    if case.elsewhere is not None:
        yield Written(case.elsewhere, seen_from_elsewhere(case.frame))


MISCONCEPTIONS = (exchanged_halves, axes_reversed, moment_signs, other_frame)


def explain_screws(case: WrongScrews) -> Finding | None:
    """The finding that explains all wrong axes; None where they are not all read.

    One wrong axis does not show what runs through all, but for the order of its halves.
    """
    if not np.isfinite(case.actual).all():
        return None
    several = int(case.wrong.any(axis=1).sum()) > 1
    return diagnosed(case, MISCONCEPTIONS if several else (exchanged_halves,))
