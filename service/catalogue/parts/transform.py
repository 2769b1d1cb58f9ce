"""Answer kind ``transform``: a homogeneous transform, such as the pose of the end effector."""

from typing import ClassVar, Literal

from service.catalogue.files.fields import Homogeneous
from service.catalogue.part import PosePartSpec
from service.catalogue.robots.formulas import WrittenFormulas, transform_of
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import MatrixShape, matrix_shape


class TransformSpec(PosePartSpec):
    """A homogeneous transform, 4×4; by default the pose of the tool in the base frame."""

    can_be_followed: ClassVar[bool] = True

    kind: Literal["transform"]
    expected: Homogeneous | None = None
    """The entries of the transform, row by row, instead of the robot's pose."""

    def formulas(self) -> WrittenFormulas | None:
        """The entries, if the file gives them."""
        return None if self.expected is None else transform_of("expected", self.expected)

    def shape(self, _: Reference | None) -> MatrixShape:
        """The shape of a 4×4 matrix."""
        return matrix_shape(4, 4)
