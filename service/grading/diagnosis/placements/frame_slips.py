"""Find which rule for placing frames a wrong frame breaks."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from service.grading.feedback import Finding
from service.grading.misconception import AnyHypothesis, check, says
from service.kinematics.dh import Convention
from service.kinematics.frames.placement import AxisPosition, RightPlace
from service.kinematics.transforms import Numbers
from service.translations import say


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
        """True for the standard DH convention."""
        # There, x must cross the z axis of the previous frame; in the modified convention that of
        # the next frame.
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
