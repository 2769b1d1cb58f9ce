"""Answer kind ``screw_axes``: the screw axis of each joint."""

from collections.abc import Iterator, Sequence
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from service.catalogue.files.fields import GivenOrFree, Screw
from service.catalogue.part import PartSpec
from service.catalogue.robots.formulas import WrittenFormulas, screws_of
from service.catalogue.robots.robot import Joint
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import AnswerShape, choices, numbered


class ScrewAxesShape(AnswerShape):
    """The shape of a list of screw axes (ω; v): one six-vector for each row."""

    posted: ClassVar[str] = "a list of six-vectors (ω; v)"

    form: Literal["screw_axes"] = "screw_axes"
    columns: list[str]
    rows: list[str]
    frame: Literal["space", "body"]
    directions: GivenOrFree

    def _clauses(self) -> Iterator[str]:
        numbers = f"{len(self.columns)} numbers (ω; v)"
        yield f"a list of screw axes, {numbers} for each of {', '.join(self.rows)}"
        yield f"{self.frame} frame"
        yield from choices(directions=self.directions)


class ScrewAxesSpec(PartSpec):
    """The screw axis (ω; v) of each joint with all joint variables 0."""

    kind: Literal["screw_axes"]
    frame: Literal["space", "body"]
    """The frame of the axes: the base frame ("space") or the tool frame ("body")."""
    directions: GivenOrFree = "given"
    """The directions of the axes: with "free", an axis may be reversed."""
    expected: Annotated[list[Screw], Field(min_length=1, max_length=12)] | None = None
    """The right axes, instead of those of the robot."""

    def formulas(self) -> WrittenFormulas | None:
        """The axes, if the file gives them."""
        return None if self.expected is None else screws_of("expected", self.expected)

    def numbers(self, joints: Sequence[Joint]) -> range:
        """The numbers of the required axes: those of the joints, or from 1 for given axes."""
        first = 1 if self.expected or not joints else joints[0].index
        return range(first, first + len(self.expected or joints))

    def shape(self, reference: Reference | None) -> ScrewAxesShape:
        """The shape of a list of six-vectors."""
        numbers = self.numbers(reference.joints if reference else ())
        return ScrewAxesShape(
            columns=numbered(6),
            rows=[str(number) for number in numbers],
            frame=self.frame,
            directions=self.directions,
        )
