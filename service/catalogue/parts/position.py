"""Answer kind ``position``: the coordinates of a point, such as the end effector's."""

from typing import Annotated, Literal

from pydantic import StringConstraints, model_validator

from service.catalogue.files.fields import Formula, advice
from service.catalogue.part import PosePartSpec
from service.catalogue.robots.formulas import WrittenFormulas, list_of
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import ListShape, list_shape
from service.translations import say, template


class PositionSpec(PosePartSpec):
    """The coordinates of a point: a frame's origin, or a point given in the file."""

    kind: Literal["position"]
    coordinates: Annotated[
        str,
        StringConstraints(pattern=r"^(x?y?z?)$", min_length=2),
        advice(template('write the coordinates that are asked for, such as "xy" or "xyz"')),
    ] = "xyz"
    """The required coordinates in order."""
    expected: list[Formula] | None = None
    """The right coordinates, instead of those of the robot."""

    def formulas(self) -> WrittenFormulas | None:
        """The coordinates, if the file gives them."""
        if self.expected is None:
            return None
        return list_of("expected[{j}]", self.expected, ["length"] * len(self.expected))

    def shape(self, _: Reference | None) -> ListShape:
        """The shape of the answer: a list of lengths."""
        return list_shape((letter, "length") for letter in self.coordinates)

    @model_validator(mode="after")
    def _one_for_each(self) -> "PositionSpec":
        if self.expected is not None and len(self.expected) != len(self.coordinates):
            raise ValueError(
                say(
                    "expected has {count} entries, but coordinates are {coordinates!r}; write "
                    "one for each",
                    count=len(self.expected),
                    coordinates=self.coordinates,
                )
            )
        return self
