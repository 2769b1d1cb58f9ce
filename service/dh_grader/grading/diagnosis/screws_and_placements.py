"""Slips in screw axes, and the rule that a wrongly placed frame breaks.

This file compares with the right axes and places; it does not know how points are counted, which
``kinds/motions.py`` and ``kinds/frames.py`` decide.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dh_grader.grading.misconception import (
    AnyHypothesis,
    Hypotheses,
    Mask,
    Written,
    WrongNumbers,
    check,
    diagnosed,
    misconception,
    says,
)
from dh_grader.grading.numbers import EXACT_VALUE, ROUNDED_VALUE, nearly_equal
from dh_grader.grading.report import Finding
from dh_grader.kinematics import Convention, Numbers
from dh_grader.kinematics.placement import AxisPosition, RightPlace
from dh_grader.translations import say

# --- Slips in a screw axis (ω; v)


@dataclass(frozen=True)
class WrongScrew(WrongNumbers):
    """A wrong screw axis and the expected one, each ``(6, SAMPLES)``."""

    # The correct axis in the other frame, or None if it is unknown.
    elsewhere: Numbers | None
    # The frame that is asked for: "space" or "body".
    frame: str

    @property
    def length_scale(self) -> float:
        """The length that errors of v are compared with."""
        return float(np.asarray(self.scale)[-1])

    @property
    def direction(self) -> Numbers:
        """The expected ω, ``(3, SAMPLES)``."""
        return self.expected[:3]

    @cached_property
    def turns(self) -> bool:
        """True if the joint turns, False if it slides along v."""
        return bool(np.abs(self.direction).max() > EXACT_VALUE)

    @cached_property
    def pitch(self) -> Numbers:
        """The pitch h = ω · v (the advance per radian), ``(SAMPLES,)``."""
        return np.asarray((self.direction * self.expected[3:]).sum(axis=0))

    @cached_property
    def moment(self) -> Numbers:
        """The part −ω × q of v, ``(3, SAMPLES)``; q is a point on the axis."""
        return self.expected[3:] - self.pitch * self.direction

    def with_velocity(self, velocity: Numbers) -> Numbers:
        """Return the screw axis with the expected ω and the given v."""
        return np.concatenate([self.direction, velocity])


def explain_screw(case: WrongScrew) -> Finding | None:
    """Return the finding that explains a wrong screw axis, or None."""
    return diagnosed(case) if np.isfinite(case.actual).all() else None


EXCHANGED_HALVES = says(
    say("ω and v are exchanged: write ω first, then v."), say("Exchange ω and v.")
)
AXIS_REVERSED = says(
    say("The axis points the opposite way: check which way the joint counts positive."),
    say("Change the sign of all six numbers."),
)
MOMENT_SIGN = says(
    say("v has the wrong sign: the turn moves the point at the origin with v = −ω × q, not ω × q."),
)


def seen_from_elsewhere(frame: str) -> Finding:
    """Return the finding that an axis is described in a frame other than ``frame``."""
    if frame == "space":
        return Finding(
            "body_for_space",
            say(
                "ω and v are written as seen from the end-effector frame. A space axis is seen "
                "from the base frame."
            ),
            say("Measure ω and the point q in the base frame, with the arm in its home position."),
        )
    return Finding(
        "space_for_body",
        say(
            "ω and v are written as seen from the base frame. A body axis is seen from the "
            "end-effector frame."
        ),
        say(
            "Measure ω and the point q in the end-effector frame, with the arm in its home "
            "position."
        ),
    )


@misconception(
    of=WrongScrew,
    rank=10,
    code="axis_reversed",
    rule="screw_axis",
    means="the axis points the opposite way, but the exercise asks for one direction",
    example=("simple-twist", "infinite-pitch", {"1/4": "-1"}),
    unlike={"1/1": "1"},
)
def axis_reversed(case: WrongScrew) -> Hypotheses:
    """The axis points the opposite way."""
    yield Written(-case.expected, AXIS_REVERSED)


@misconception(
    of=WrongScrew,
    rank=20,
    code="moment_sign",
    rule="screw_axis",
    means="v is ω × q instead of −ω × q",
    example=("simple-twist", "zero-pitch", {"1/5": "2"}),
    unlike="[1, -2, 0, 0, 0, 0]",
)
def moment_sign(case: WrongScrew) -> Hypotheses:
    """The student wrote v = ω × q instead of −ω × q."""
    if case.turns:
        velocity = case.pitch * case.direction - case.moment
        yield Written(case.with_velocity(velocity), MOMENT_SIGN)


@misconception(
    of=WrongScrew,
    rank=30,
    code=("body_for_space", "space_for_body"),
    rule="screw_axis",
    means=(
        "the body axis is given for the space axis",
        "the space axis is given for the body axis",
    ),
    example=("planar-rpr-poe", "space-screws", {"3/5": "L2"}),
    unlike={"1/3": "2"},
)
def screw_axis_other_frame(case: WrongScrew) -> Hypotheses:
    """The axis is described in the wrong frame: body for space, or space for body."""
    if case.elsewhere is not None:
        yield Written(case.elsewhere, seen_from_elsewhere(case.frame))


@misconception(
    of=WrongScrew,
    rank=40,
    code="infinite_pitch",
    rule="screw_axis",
    means="a turning joint is written as a sliding one, or a sliding joint as a turning one",
    example=("simple-twist", "infinite-pitch", {"1/1": "1"}),
    unlike={"1/5": "1"},
)
def sliding_as_turning(case: WrongScrew) -> Hypotheses:
    """The axis of a sliding joint was written like that of a turning joint."""
    finding = says(
        say("This joint slides and does not turn: check which of ω and v holds its direction."),
        say("ω is 0, and v is the unit vector of the direction."),
    )
    if not case.turns and (np.abs(case.actual[:3]).max(axis=0) > EXACT_VALUE).all():
        # For any ω and v that were written.
        yield Written(case.actual, finding)


@misconception(
    of=WrongScrew,
    rank=50,
    code="infinite_pitch",
    rule="screw_axis",
    means="a turning joint is written as a sliding one, or a sliding joint as a turning one",
    example=("planar-rpr-poe", "space-screws", {"1/3": "0", "1/6": "1"}),
    unlike={"1/3": "0", "1/5": "1"},
)
def turning_as_sliding(case: WrongScrew) -> Hypotheses:
    """The axis of a turning joint was written like that of a sliding joint."""
    finding = says(
        say("This joint turns and does not slide: check which of ω and v holds its direction."),
        say("ω is the unit vector along the axis, and v = −ω × q."),
    )
    if case.turns:
        yield Written(np.concatenate([0 * case.direction, case.direction]), finding)


@misconception(
    of=WrongScrew,
    rank=60,
    code="exchanged_halves",
    rule="screw_axis",
    means="the axis is written as (v; ω) instead of (ω; v)",
    example=("planar-rpr-poe", "space-screws", {"3/2": "-L1", "3/3": "0", "3/5": "0", "3/6": "1"}),
    unlike={"1/3": "0", "1/5": "1"},
)
def screw_axis_exchanged_halves(case: WrongScrew) -> Hypotheses:
    """The axis was written as (v; ω) instead of (ω; v)."""
    yield Written(np.concatenate([case.expected[3:], case.direction]), EXCHANGED_HALVES)


@misconception(
    of=WrongScrew,
    rank=70,
    code="not_normalised",
    rule="screw_axis",
    means="ω, or v of a sliding joint, is not a unit vector",
    example=("simple-twist", "infinite-pitch", {"1/4": "2"}),
    unlike={"1/4": "0"},
)
def not_normalised(case: WrongScrew) -> Hypotheses:
    """The unit vector (ω, or v of a sliding joint) does not have length 1."""
    letter, unit = ("ω", slice(0, 3)) if case.turns else ("v", slice(3, 6))
    finding = says(
        say(
            "The direction is right, but {letter} is not of length 1, as it must be.",
            letter=letter,
        ),
        say("Divide all six numbers by the length of {letter}.", letter=letter),
    )
    factor = (case.actual[unit] * case.expected[unit]).sum(axis=0)
    if (np.abs(factor) >= EXACT_VALUE).all():
        yield Written(factor * case.expected, finding)


@misconception(
    of=WrongScrew,
    rank=80,
    code="point_for_velocity",
    rule="screw_axis",
    means="v is a point on the axis",
    example=("planar-rpr-poe", "space-screws", {"3/4": "L1", "3/5": "0"}),
    unlike={"1/3": "0", "1/5": "1"},
)
def point_for_velocity(case: WrongScrew) -> Hypotheses:
    """The student wrote a point on the axis instead of v."""
    finding = says(say("v holds a point q on the axis. It must be a velocity, v = −ω × q."))
    if case.turns and np.abs(case.moment).max() >= EXACT_VALUE:
        point = case.actual[3:]
        of_point = -np.cross(case.direction, point, axis=0)
        if nearly_equal(of_point, case.moment, case.length_scale).all():
            yield Written(case.with_velocity(point), finding)


@misconception(
    of=WrongScrew,
    rank=90,
    code="pitch",
    rule="screw_axis",
    means="the part of v along ω, which gives the pitch, is wrong",
    example=("simple-twist", "zero-pitch", {"1/6": "1"}),
    unlike={"1/4": "1"},
)
def pitch(case: WrongScrew) -> Hypotheses:
    """The part of v along ω, which gives the pitch, is wrong."""
    if not case.turns:
        return
    hint = say("The part of v along ω is not right: check the pitch of this joint.")
    along = ((case.actual[3:] - case.moment) * case.direction).sum(axis=0)
    if np.abs(along - case.pitch).max() >= ROUNDED_VALUE * case.length_scale:
        velocity = case.moment + along * case.direction
        yield Written(case.with_velocity(velocity), says(hint, say("v = −ω × q + h ω.")))


@misconception(
    of=WrongScrew,
    rank=100,
    code="point_off_axis",
    rule="screw_axis",
    means="ω is right, but v is computed from a point that is not on the axis",
    example=("simple-twist", "pitch", {"1/4": "1"}),
    unlike={"1/1": "1"},
)
def point_off_axis(case: WrongScrew) -> Hypotheses:
    """The student computed v from a point that is not on the axis."""
    if case.frame == "space":
        hint = say(
            "ω is right, v is not: v = −ω × q needs a point q on this axis. Check the coordinates "
            "of q in the base frame, and the cross product."
        )
    else:
        hint = say(
            "ω is right, v is not: v = −ω × q needs a point q on this axis. Check the coordinates "
            "of q in the end-effector frame, and the cross product."
        )
    along = (case.actual[3:] * case.direction).sum(axis=0)
    if case.turns and nearly_equal(along, case.pitch, case.length_scale):
        yield Written(case.with_velocity(case.actual[3:]), says(hint))


@misconception(
    of=WrongScrew,
    rank=110,
    code="other_direction",
    rule="screw_axis",
    means="the unit vector is not parallel to the axis",
    example=("simple-twist", "infinite-pitch", "[0, 0, 0, 0, 0, 1]"),
    unlike={"1/1": "1"},
)
def other_direction(case: WrongScrew) -> Hypotheses:
    """The unit vector (ω, or v of a sliding joint) is not parallel to the joint axis."""
    letter, unit = ("ω", slice(0, 3)) if case.turns else ("v", slice(3, 6))
    finding = says(
        say(
            "{letter} is not along the axis of this joint: check the axis in the home position.",
            letter=letter,
        ),
    )
    length = np.sqrt((case.actual[unit] ** 2).sum(axis=0))
    along = (case.actual[unit] * case.expected[unit]).sum(axis=0)
    if nearly_equal(length, np.ones_like(length)) and np.abs(np.abs(along) - 1).max() > EXACT_VALUE:
        yield Written(case.actual, finding)


# --- Slips in the screw axes of all joints


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


def explain_screws(case: WrongScrews) -> Finding | None:
    """Return the finding that explains all wrong axes, or None.

    If only one axis is wrong, only the order of ω and v is checked.
    """
    if not np.isfinite(case.actual).all():
        return None
    return diagnosed(case)


@misconception(
    of=WrongScrews,
    rank=10,
    code="exchanged_halves",
    rule="screw_axis",
    means="the axis is written as (v; ω) instead of (ω; v)",
    example=("simple-twist", "infinite-pitch", "1, 0, 0, 0, 0, 0"),
    unlike={"1/2": "90"},
)
def all_screws_exchanged_halves(case: WrongScrews) -> Hypotheses:
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
def all_screws_other_frame(case: WrongScrews) -> Hypotheses:
    """Every axis is described in the wrong frame: body for space, or space for body."""
    if case.elsewhere is not None:
        yield Written(case.elsewhere, seen_from_elsewhere(case.frame))


# --- Find which rule for placing frames a wrong frame breaks


@dataclass(frozen=True)
class WrongPlacement:
    """A wrong value of a frame that the student placed."""

    convention: Convention
    place: RightPlace
    # The largest accepted deviation from a rule.
    slack: float

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterable[AnyHypothesis]:
        """Return all hypotheses (possible mistakes)."""
        return hypotheses

    @property
    def is_standard(self) -> bool:
        """True for the standard DH convention.

        There, x must cross the z axis of the previous frame; in the modified convention that of the
        next frame.
        """
        return self.convention is Convention.STANDARD


@dataclass(frozen=True)
class WrongJointAxis(WrongPlacement):
    """A wrong joint number of a frame; ``right`` is the correct number."""

    chosen: int
    right: int


@dataclass(frozen=True)
class WrongFrameZ(WrongPlacement):
    """A wrong z direction ``(SAMPLES, 3)`` of a frame."""

    z: Numbers


@dataclass(frozen=True)
class WrongFrameOrigin(WrongPlacement):
    """A wrong origin ``(SAMPLES, 3)`` of a frame."""

    origin: Numbers


@dataclass(frozen=True)
class WrongFrameX(WrongPlacement):
    """A wrong x direction ``(SAMPLES, 3)`` of a frame."""

    x: Numbers

    def is_perpendicular_to(self, axis: Numbers) -> bool:
        """True if x is perpendicular to an axis direction ``(SAMPLES, 3)``."""
        return bool(np.abs((self.x * axis).sum(axis=-1)).max() <= self.slack)


_FRAMES = "stanford-arm-frames"


@check(
    of=WrongJointAxis,
    rank=10,
    code="axis_of_other_convention",
    rule="frame_z",
    means="z of a frame is along the axis that the other convention takes for this frame",
    example=(_FRAMES, "frames", {"2/axis": "2"}),
    unlike={"2/axis": "5"},
)
def axis_of_other_convention(case: WrongJointAxis) -> Finding | None:
    """The joint number would be correct in the other convention."""
    step = -1 if case.is_standard else 1
    if case.chosen != case.right + step:
        return None
    if case.is_standard:
        hint = say(
            "The modified convention puts z of this frame along that axis; here the standard "
            "convention is asked for."
        )
    else:
        hint = say(
            "The standard convention puts z of this frame along that axis; here the modified "
            "convention is asked for."
        )
    return says(hint, say("Put z along the axis of joint {joint}.", joint=case.right))


@check(
    of=WrongJointAxis,
    rank=20,
    code="wrong_joint_axis",
    rule="frame_z",
    means="z of a frame is along the axis of another joint",
    example=(_FRAMES, "frames", {"2/axis": "5"}),
    unlike={"2/axis": "2"},
)
def wrong_joint_axis(case: WrongJointAxis) -> Finding | None:
    """The joint number is wrong in both conventions."""
    return says(
        say("z of this frame belongs on the axis of another joint: count the joints again."),
        say("Put z along the axis of joint {joint}.", joint=case.right),
    )


@check(
    of=WrongFrameZ,
    rank=10,
    code="z_not_along_axis",
    rule="frame_z",
    means="z of a frame is not along its joint axis",
    example=(_FRAMES, "frames", {"1/z": "+z"}),
    unlike={"2/x": "+z"},
)
def z_not_along_axis(_: WrongFrameZ) -> Finding | None:
    """The axis z does not point along the joint axis."""
    return says(
        say(
            "z must be along the joint axis about which the joint turns, or along which it "
            "slides, in either sense."
        )
    )


@check(
    of=WrongFrameOrigin,
    rank=10,
    code="origin_off_axis",
    rule="frame_origin",
    means="the origin of a frame is not on its joint axis",
    example=(_FRAMES, "frames", {"5/origin_x": "d2"}),
    unlike={"5/origin_z": "d2"},
)
def origin_off_axis(case: WrongFrameOrigin) -> Finding | None:
    """The origin is not on the joint axis."""
    if case.place.own.distance(case.origin) <= case.slack:
        return None
    return says(say("The origin is not on the joint axis along which z lies."))


@check(
    of=WrongFrameOrigin,
    rank=20,
    code="origin_not_at_intersection",
    rule="frame_origin",
    means="the origin of a frame is on its axis, but not where it meets the neighbouring axis",
    example=(_FRAMES, "frames", {"5/origin_z": "d2"}),
    unlike={"5/origin_x": "d2"},
)
def origin_not_at_intersection(case: WrongFrameOrigin) -> Finding | None:
    """The axes cross, but the origin is not at their intersection."""
    if case.place.relation is not AxisPosition.CROSSING:
        return None
    if case.is_standard:
        return says(
            say(
                "The joint axis crosses the z axis of the frame before it: the origin belongs "
                "where they meet."
            )
        )
    return says(
        say(
            "The joint axis crosses the z axis of the frame after it: the origin belongs where "
            "they meet."
        )
    )


@check(
    of=WrongFrameOrigin,
    rank=30,
    code="origin_not_on_normal",
    rule="frame_origin",
    means="the origin of a frame is on its axis, but not at the foot of the common normal",
    example=("spatial-rrr-frames", "frames", {"1/origin_y": "L1"}),
    unlike={"1/origin_x": "L1"},
)
def origin_not_on_normal(case: WrongFrameOrigin) -> Finding | None:
    """The axes are skew, but the origin is not at the foot of their common normal."""
    if case.place.relation is not AxisPosition.SKEW:
        return None
    if case.is_standard:
        return says(
            say(
                "The origin belongs at the foot of the common normal of the joint axis and the z "
                "axis of the frame before it."
            )
        )
    return says(
        say(
            "The origin belongs at the foot of the common normal of the joint axis and the z axis "
            "of the frame after it."
        )
    )


@check(
    of=WrongFrameX,
    rank=10,
    code="x_not_perpendicular",
    rule="frame_x",
    means="x of a frame is not perpendicular to its own z",
    example=(_FRAMES, "frames", {"2/x": "+z"}),
    unlike={"2/x": "+y"},
)
def x_not_perpendicular(case: WrongFrameX) -> Finding | None:
    """The direction of x is not perpendicular to the joint axis."""
    if case.is_perpendicular_to(case.place.own.direction):
        return None
    return says(say("x must be perpendicular to z of its own frame."))


@check(
    of=WrongFrameX,
    rank=20,
    code="x_not_perpendicular_to_neighbour",
    rule="frame_x",
    means="x of a frame is not perpendicular to the neighbouring z, which it must cross",
    example=(_FRAMES, "frames", {"2/x": "+y"}),
    unlike={"2/x": "+z"},
)
def x_not_perpendicular_to_neighbour(case: WrongFrameX) -> Finding | None:
    """The direction of x is not perpendicular to the neighbouring axis."""
    if case.is_perpendicular_to(case.place.neighbour.direction):
        return None
    if case.is_standard:
        return says(say("x must be perpendicular to the z axis of the frame before it, too."))
    return says(say("x must be perpendicular to the z axis of the frame after it, too."))


@check(
    of=WrongFrameX,
    rank=30,
    code="x_not_crossing",
    rule="frame_x",
    means="x of a frame passes beside the neighbouring z, which it must cross",
    example=("planar-rrr-frames", "frames", {"2/x": "+y"}),
    unlike={"2/x": "+z"},
)
def x_not_crossing(case: WrongFrameX) -> Finding | None:
    """The line of x does not meet the neighbouring axis."""
    if case.is_standard:
        return says(
            say(
                "x must cross the z axis of the frame before it: it is along the common normal of "
                "both axes."
            )
        )
    return says(
        say(
            "x must cross the z axis of the frame after it: it is along the common normal of both "
            "axes."
        )
    )
