"""Answer kind ``frames``: the frames that the student places on the joint axes."""

from collections.abc import Iterator
from typing import ClassVar, Literal

from service.catalogue.part import TablePartSpec
from service.catalogue.robots.formulas import FieldError
from service.catalogue.robots.robot import Robot
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import AnswerShape
from service.kinematics.dh import Convention
from service.translations import say

# The labels of a frame's cells.
COORDINATES = ("origin_x", "origin_y", "origin_z")
FRAME_CELLS = ("axis", "z", *COORDINATES, "x")


class FramesShape(AnswerShape):
    """The shape of a list of frames on joint axes, described in the base frame."""

    posted: ClassVar[str] = '`[{"axis": 2, "z": "+y", "origin": ["0", "d1", "0"], "x": "+x"}, …]`'

    form: Literal["frames"] = "frames"
    columns: list[str]
    rows: list[str]
    joints: list[str]
    convention: Convention

    def _clauses(self) -> Iterator[str]:
        rows = ", ".join(self.rows)
        yield f"a row for each of the frames {rows}: its joint axis, z, origin and x"
        yield "in the base frame"
        yield f"{self.convention} convention"
        yield "with all joint variables 0"


class FramesSpec(TablePartSpec):
    """The frames on the joint axes, between the base frame and the tool frame.

    Directions and points are in the base frame, with all joint variables 0. Every choice by the
    rules of the convention is right. The base frame and the tool frame are given.
    """

    kind: Literal["frames"]
    convention: Convention
    """"standard" (distal): z of frame i is along the axis of joint i + 1. "modified" (proximal): z
    of frame i is along the axis of joint i."""

    def check_reference(self, field: str, reference: Reference | None) -> None:
        """Raise FieldError unless the robot has frames to place, all on joint axes."""
        super().check_reference(field, reference)
        assert isinstance(reference, Robot)
        fixed = len(reference.tables[self.convention].rows) - len(reference.joints)
        if fixed > (self.convention is Convention.MODIFIED):
            raise FieldError(
                f"{field}.convention",
                say(
                    "the robot's {convention} table has a fixed row whose frame is on no joint "
                    "axis; ask for the frames of the other convention",
                    convention=self.convention.value,
                ),
            )
        if not frame_labels(reference, self.convention):
            raise FieldError(f"{field}.kind", say("the robot has no frame between base and tool"))

    def shape(self, reference: Reference | None) -> FramesShape:
        """The shape of a list of frames."""
        assert isinstance(reference, Robot)
        return FramesShape(
            columns=list(FRAME_CELLS),
            rows=frame_labels(reference, self.convention),
            joints=[str(joint.index) for joint in reference.joints],
            convention=self.convention,
        )


def frame_labels(robot: Robot, convention: Convention) -> list[str]:
    """Return the numbers of the frames between the base frame and the tool frame."""
    first = robot.joints[0].index
    rows = len(robot.tables[convention].rows)
    return [str(first + i) for i in range(rows - 1)]
