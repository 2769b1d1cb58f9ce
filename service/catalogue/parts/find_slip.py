"""Answer kind ``find_slip``: the one mistake (slip) in a given Denavit-Hartenberg table."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal, TypeAlias

from pydantic import Field, model_validator

from service.catalogue.files.fields import GivenOrFree, NotBool
from service.catalogue.part import TablePartSpec
from service.catalogue.parts.dh_table import DhTableSpec
from service.catalogue.robots.robot import Robot
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import AnswerShape, choices
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention
from service.translations import say

# The codes of the misconceptions that a table can be given.
SlipName: TypeAlias = Literal[
    "sign",
    "distance_left_out",
    "distance_extra",
    "degrees_as_radians",
    "radians_as_degrees",
    "quarter_turn",
    "half_turn",
    "unknown_symbol",
    "joint_variable_absent",
    "joint_variable_missing",
    "joint_variable_sign",
    "joint_variable_index",
    "joint_variable_doubled",
    "joint_variable_column",
    "joint_variable_extra",
    "wrong_quantity",
    "columns_swapped",
    "column_sign",
    "row_order",
    "lengths_exchanged",
    "link_columns_shifted",
    "other_convention",
    "joint_numbering",
    "joint_numbering_by_kind",
]
_LARGEST = 999_999


class FindSlipShape(AnswerShape):
    """The shape of the answer: a mark on the slip, and the table without it."""

    posted: ClassVar[str] = (
        '`{"marked": "2.alpha", "table": {"rows": [{"a", "alpha", "d", "theta"}, …]}}`'
    )

    form: Literal["find_slip"] = "find_slip"
    columns: list[str]
    rows: list[str] = Field(
        description="Row labels in order: joint numbers, `e` for the end effector."
    )
    convention: Convention
    frames: GivenOrFree
    given: list[list[str]] = Field([], description="The table with one slip, row by row.")

    def _clauses(self) -> Iterator[str]:
        rows, columns = ", ".join(self.rows), ", ".join(self.columns)
        yield f"a mark on the slip in a table with the rows {rows} and the columns {columns}"
        yield "the table without the slip"
        yield f"{self.convention} convention"
        yield from choices(frames=self.frames)
        if self.given:
            yield f"given is {' / '.join(', '.join(row) for row in self.given)}"


class FindSlipSpec(TablePartSpec):
    """A Denavit-Hartenberg table with one slip, which the student marks and mends.

    The marked cells are worth half of the points, the mended table the other half.
    """

    pasted_as = "table"

    kind: Literal["find_slip"]
    convention: Convention
    """"standard" (distal) or "modified" (proximal)."""
    seed: Annotated[int, Field(ge=0, le=_LARGEST, strict=True), NotBool] = 0
    """The number that draws the slip. Another seed draws another slip."""
    slip: SlipName | None = None
    """The code of the misconception that the table shows, such as "sign". Without it, the seed
    draws one of all that fit the robot."""
    frames: GivenOrFree = "free"
    """The link frames of the mended table: "free" accepts every valid choice, "given" only those
    of the reference."""

    @property
    def table(self) -> DhTableSpec:
        """Return an equivalent part of the kind ``dh_table``."""
        return DhTableSpec(
            id=self.id,
            title=self.title,
            points=self.points,
            kind="dh_table",
            convention=self.convention,
            frames=self.frames,
        )

    def shape(self, reference: Reference | None) -> FindSlipShape:
        """Return the shape of an answer, without the cells of the given table."""
        assert isinstance(reference, Robot)
        return FindSlipShape(
            columns=list(COLUMNS),
            rows=list(reference.tables[self.convention].labels),
            convention=self.convention,
            frames=self.frames,
        )

    @model_validator(mode="after")
    def _is_marked_by_halves(self) -> "FindSlipSpec":
        if self.marking not in ("content", "whole"):
            raise ValueError(
                say(
                    'marking = "{marking}" is not possible here, because marking and mending are '
                    'each worth half; leave marking out or write marking = "whole"',
                    marking=self.marking,
                )
            )
        return self
