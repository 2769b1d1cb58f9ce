"""Answer kind ``vector``: a list of values, such as (p_x, p_y, φ)."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from service.catalogue.files.fields import Formula, StrictModel, Text
from service.catalogue.part import PartSpec
from service.catalogue.robots.formulas import WrittenFormulas, list_of
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import ListShape, list_shape
from service.expressions import Kind


class ComponentSpec(StrictModel):
    """One component of a vector."""

    name: Text
    """The name of the component."""
    quantity: Kind
    """The quantity: an angle, a length or a plain number."""
    expected: Formula
    """The right value."""


class VectorSpec(PartSpec):
    """A list of values, each a length, an angle or a number, such as (p_x, p_y, φ)."""

    answer_fields: ClassVar[tuple[str, ...]] = ("components",)

    kind: Literal["vector"]
    components: Annotated[list[ComponentSpec], Field(min_length=1, max_length=12)]
    """The values in order."""

    def formulas(self) -> WrittenFormulas:
        """The formula of each component's right value."""
        return list_of(
            "components[{j}].expected",
            [component.expected for component in self.components],
            [component.quantity for component in self.components],
        )

    def shape(self, _: Reference | None) -> ListShape:
        """The shape of the list of components."""
        return list_shape((each.name, each.quantity) for each in self.components)
