"""Slips in a screw axis (ω; v).

Each function is one misconception that the student may have held. It returns what to say where the
axis without that misconception is right, else None.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from service.grading.comparison import Match, matches
from service.grading.feedback import Finding
from service.grading.tolerances import EXACT_VALUE, ROUNDED_VALUE
from service.kinematics.transforms import Numbers

SCREW_LABELS = ("ω1", "ω2", "ω3", "v1", "v2", "v3")


@dataclass(frozen=True)
class WrongScrew:
    """A screw axis that is not the expected one, ``(6, SAMPLES)`` each, with a value everywhere.

    ``elsewhere`` is the same axis seen from the other frame, the tool's for the base's or the other
    way; None where that is not known. ``frame`` is "space" or "body", whichever is asked for.
    """

    actual: Numbers
    expected: Numbers
    elsewhere: Numbers | None
    frame: str
    length_scale: float

    def is_what_was_written(self, other: Numbers) -> bool:
        """Whether the axis that was handed in is ``other``."""
        scale = np.repeat([1.0, self.length_scale], 3)
        return bool((matches(self.actual, other, scale) >= Match.ROUNDED).all())

    @cached_property
    def turns(self) -> bool:
        """Whether the joint turns; else it slides along v."""
        return bool(np.abs(self.expected[:3]).max() > EXACT_VALUE)

    @cached_property
    def pitch(self) -> Numbers:
        """The advance per radian h = ω · v, ``(SAMPLES,)``."""
        return np.asarray((self.expected[:3] * self.expected[3:]).sum(axis=0))

    @cached_property
    def moment(self) -> Numbers:
        """−ω × q, what v has from the place of the axis, ``(3, SAMPLES)``."""
        return self.expected[3:] - self.pitch * self.expected[:3]

    def with_velocity(self, velocity: Numbers) -> Numbers:
        """The expected ω with another v."""
        return np.concatenate([self.expected[:3], velocity])


def other_frame(case: WrongScrew) -> Finding | None:
    """The body axis was given for the space axis, or the other way."""
    if case.elsewhere is None or not case.is_what_was_written(case.elsewhere):
        return None
    seen, asked = ("tool", "base") if case.frame == "space" else ("base", "tool")
    code = "body_for_space" if case.frame == "space" else "space_for_body"
    return Finding(
        code,
        f"This is the axis as seen from the {seen} frame; the {case.frame} axis is seen from the "
        f"{asked} frame.",
        f"Measure ω and the point q in the {asked} frame, with the arm in its home position.",
    )


def moment_sign(case: WrongScrew) -> Finding | None:
    """V was taken to be ω × q."""
    if not case.turns:
        return None
    turned = case.with_velocity(-case.moment + case.pitch * case.expected[:3])
    if not case.is_what_was_written(turned):
        return None
    return Finding(
        "moment_sign",
        "v has the wrong sign: it is the velocity that the turn gives to the point at the origin, "
        "−ω × q and not ω × q.",
    )


def axis_reversed(case: WrongScrew) -> Finding | None:
    """The axis was taken to point the opposite way."""
    if not case.is_what_was_written(-case.expected):
        return None
    return Finding(
        "axis_reversed",
        "This axis points the opposite way: look which way the joint counts positive.",
        "Change the sign of all six numbers.",
    )


def not_normalised(case: WrongScrew) -> Finding | None:
    """ω, or v of a sliding joint, is not of unit length."""
    direction = slice(0, 3) if case.turns else slice(3, 6)
    factor = (case.actual[direction] * case.expected[direction]).sum(axis=0)
    if (np.abs(factor) < EXACT_VALUE).any() or not case.is_what_was_written(factor * case.expected):
        return None
    letter = "ω" if case.turns else "v"
    return Finding(
        "not_normalised",
        f"The direction is right, but {letter} of this axis must be a unit vector.",
        f"Divide all six numbers by the length of {letter}.",
    )


def sliding_as_turning(case: WrongScrew) -> Finding | None:
    """The direction of a sliding joint was written in ω: infinite pitch is ω = 0."""
    if case.turns:
        return None
    on_axis = matches(case.actual[:3], case.expected[3:], 1.0) >= Match.ROUNDED
    reversed_axis = matches(case.actual[:3], -case.expected[3:], 1.0) >= Match.ROUNDED
    if not (on_axis.all() or reversed_axis.all()):
        return None
    return Finding(
        "infinite_pitch",
        "This joint slides, so its pitch is infinite: nothing turns.",
        "ω is 0, and v is the unit vector of the direction.",
    )


def turning_as_sliding(case: WrongScrew) -> Finding | None:
    """The axis of a turning joint was written in v."""
    if not case.turns:
        return None
    along = np.concatenate([np.zeros_like(case.expected[:3]), case.expected[:3]])
    if not case.is_what_was_written(along):
        return None
    return Finding(
        "infinite_pitch",
        "This joint turns, so its pitch is finite: with ω = 0 it would slide.",
        "ω is the unit vector along the axis, and v = −ω × q.",
    )


def exchanged_halves(case: WrongScrew) -> Finding | None:
    """V was written in front of ω."""
    if not case.is_what_was_written(np.concatenate([case.expected[3:], case.expected[:3]])):
        return None
    return Finding("exchanged_halves", "ω comes first here, v second: the order is (ω; v).")


def point_for_velocity(case: WrongScrew) -> Finding | None:
    """A point on the axis was written in place of v."""
    if not case.turns or np.abs(case.moment).max() < EXACT_VALUE:
        return None
    omega, point = case.expected[:3], case.actual[3:]
    if not case.is_what_was_written(case.with_velocity(point)):
        return None
    of_point = -np.cross(omega, point, axis=0)
    if not (matches(of_point, case.moment, case.length_scale) >= Match.ROUNDED).all():
        return None
    return Finding(
        "point_for_velocity",
        "v is not a point on the axis, but the velocity that the turn gives to the point at the "
        "origin: v = −ω × q.",
    )


def pitch(case: WrongScrew) -> Finding | None:
    """The advance along the axis was left out, added, or is another."""
    if not case.turns:
        return None
    along = ((case.actual[3:] - case.moment) * case.expected[:3]).sum(axis=0)
    if np.abs(along - case.pitch).max() < ROUNDED_VALUE * case.length_scale:
        return None
    if not case.is_what_was_written(case.with_velocity(case.moment + along * case.expected[:3])):
        return None
    if np.abs(case.pitch).max() < EXACT_VALUE:
        look = "This axis has pitch 0, it only turns: v has no part along ω."
    else:
        look = "Of v the part along ω is not right: it is the pitch h times ω."
    return Finding("pitch", look, "v = −ω × q + h ω.")


MISCONCEPTIONS: tuple[Callable[[WrongScrew], Finding | None], ...] = (
    axis_reversed,
    moment_sign,
    other_frame,
    sliding_as_turning,
    turning_as_sliding,
    exchanged_halves,
    not_normalised,
    point_for_velocity,
    pitch,
)


def explain_screw(case: WrongScrew) -> Finding | None:
    """The first misconception that explains the whole of a wrong axis."""
    if case.is_what_was_written(case.expected) or not np.isfinite(case.actual).all():
        return None
    for misconception in MISCONCEPTIONS:
        finding = misconception(case)
        if finding is not None:
            return finding
    return None
