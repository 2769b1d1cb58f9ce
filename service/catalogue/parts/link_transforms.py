"""Answer kind ``link_transforms``: the transform of each row of a table."""

from collections.abc import Iterator
from typing import ClassVar, Literal

from service.catalogue.files.fields import GivenOrFree
from service.catalogue.part import TablePartSpec
from service.catalogue.robots.robot import Robot
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import AnswerShape, choices, numbered
from service.kinematics.dh import Convention


class LinkTransformsShape(AnswerShape):
    """A list of 4×4 matrices, one for each row of the table; report rows are "A1.1" and so on."""

    posted: ClassVar[str] = "a list of matrices"

    form: Literal["link_transforms"] = "link_transforms"
    matrices: list[str]
    rows: list[str]
    columns: list[str]
    convention: Convention
    frames: GivenOrFree

    def _clauses(self) -> Iterator[str]:
        size = f"{len(self.rows)} rows and {len(self.columns)} columns"
        yield f"a list of the matrices {', '.join(self.matrices)}, each of {size}"
        yield f"{self.convention} convention"
        yield from choices(frames=self.frames)


class LinkTransformsSpec(TablePartSpec):
    """The link transforms A_1 … A_n, one for each row of the robot's table."""

    holds_links: ClassVar[bool] = True

    kind: Literal["link_transforms"]
    convention: Convention
    """"standard" (distal) or "modified" (proximal)."""
    frames: GivenOrFree = "given"
    """The link frames: "free" accepts the transforms of any valid table, or, if the part follows a
    table, of the student's own."""

    def shape(self, reference: Reference | None) -> LinkTransformsShape:
        """The shape: the names of the matrices and their size."""
        assert isinstance(reference, Robot)
        return LinkTransformsShape(
            matrices=[f"A{row}" for row in reference.tables[self.convention].labels],
            rows=numbered(4),
            columns=numbered(4),
            convention=self.convention,
            frames=self.frames,
        )
