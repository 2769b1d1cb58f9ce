"""Answer kind ``euler_angles``: three angles that describe a rotation."""

from typing import Literal

from pydantic import model_validator

from service.catalogue.files.fields import Triple
from service.catalogue.part import PosePartSpec
from service.catalogue.robots.formulas import WrittenFormulas, list_of
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import ListShape, list_shape
from service.translations import say


class EulerAnglesSpec(PosePartSpec):
    """Three angles that describe a rotation; every triple for the same rotation is right."""

    pasted_as = "angles"

    kind: Literal["euler_angles"]
    sequence: Literal[
        "RPY", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"
    ]
    """The axes in the order of the rotations. "RPY" is Rz(α) Ry(β) Rx(γ), answered as α, β, γ: the
    same as "ZYX" about moving axes."""
    axes: Literal["moving", "fixed"] = "moving"
    """The frame of the axes: the moving or the fixed one."""
    expected: Triple | None = None
    """One right triple of angles, instead of the robot's orientation."""

    @property
    def turns(self) -> str:
        """The letters of the three rotation axes, such as "ZYX"."""
        return "ZYX" if self.sequence == "RPY" else self.sequence

    def formulas(self) -> WrittenFormulas | None:
        """The angles, if the file gives them."""
        if self.expected is None:
            return None
        return list_of("expected[{j}]", self.expected, ["angle"] * 3)

    def shape(self, _: Reference | None) -> ListShape:
        """The shape of a list of three angles about the axes."""
        listed = list_shape((f"about {axis.lower()}", "angle") for axis in self.turns)
        return listed.model_copy(update={"sequence": self.sequence, "axes": self.axes})

    @model_validator(mode="after")
    def _rpy_is_about_moving_axes(self) -> "EulerAnglesSpec":
        if self.sequence == "RPY" and self.axes == "fixed":
            raise ValueError(
                say(
                    'sequence "RPY" is answered as Rz(α) Ry(β) Rx(γ); write sequence = "XYZ" '
                    'with axes = "fixed" for roll, pitch, yaw in this order'
                )
            )
        return self
