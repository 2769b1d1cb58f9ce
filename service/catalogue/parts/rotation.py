"""Answer kind ``rotation``: a rotation matrix."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from service.catalogue.files.fields import Formula, StrictModel, Triple
from service.catalogue.part import PosePartSpec
from service.catalogue.robots.formulas import (
    ROTATION,
    WrittenFormulas,
    check_rotation,
    list_of,
    matrix_of,
)
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import MatrixShape, matrix_shape


class StepSpec(StrictModel):
    """One step of a composite rotation."""

    axis: Literal["x", "y", "z"]
    """The axis of the step."""
    angle: Formula
    """The angle of the step."""
    about: Literal["fixed", "moving"] = "moving"
    """The frame of the axis: the fixed or the moving one."""


class RotationSpec(PosePartSpec):
    """A rotation matrix, 3×3: of a pose of the robot, or given by its entries or by steps."""

    answer_fields: ClassVar[tuple[str, ...]] = ("expected", "steps")

    kind: Literal["rotation"]
    expected: tuple[Triple, Triple, Triple] | None = None
    """The entries of the rotation, row by row, instead of the robot's rotation or ``steps``."""
    steps: Annotated[list[StepSpec], Field(min_length=1, max_length=6)] | None = None
    """The steps of the rotation in order, instead of the robot's rotation or ``expected``."""

    def formulas(self) -> WrittenFormulas | None:
        """The entries or the angles of the steps, if the file gives them."""
        if self.expected is not None:
            return matrix_of("expected", self.expected, ROTATION, check_rotation)
        if self.steps is not None:
            angles = [step.angle for step in self.steps]
            return list_of("steps[{j}].angle", angles, ["angle"] * len(angles))
        return None

    def shape(self, _: Reference | None) -> MatrixShape:
        """The shape of a 3×3 matrix."""
        return matrix_shape(3, 3)
