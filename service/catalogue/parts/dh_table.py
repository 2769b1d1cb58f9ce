"""Answer kind ``dh_table``: a Denavit-Hartenberg table of the robot."""

from collections.abc import Iterator
from typing import ClassVar, Literal, TypeAlias

from pydantic import Field, model_validator

from service.catalogue.files.fields import GivenOrFree
from service.catalogue.part import TablePartSpec
from service.catalogue.robots.robot import Robot
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import AnswerShape, choices
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention

# Whether an empty cell counts for nothing, or for 0.
EmptyCells: TypeAlias = Literal["unread", "zero"]

_CHOICES = {"frames", "base", "tool", "directions"}


class DhTableShape(AnswerShape):
    """The shape of a table, and whose choice its frames are."""

    posted: ClassVar[str] = '`{"rows": [{"a", "alpha", "d", "theta"}, …]}`'

    form: Literal["dh_table"] = "dh_table"
    columns: list[str]
    rows: list[str] = Field(
        description="Row labels in order: joint numbers, `e` for the end effector. Where either "
        "convention will do, those of the longer table."
    )
    convention: Convention | Literal["either"]
    frames: GivenOrFree
    base: GivenOrFree
    tool: GivenOrFree
    directions: GivenOrFree
    empty_cells: EmptyCells

    def _clauses(self) -> Iterator[str]:
        rows, columns = ", ".join(self.rows), ", ".join(self.columns)
        yield f"a table with the rows {rows} and the columns {columns}"
        yield f"{self.convention} convention"
        yield from choices(**self.model_dump(include=_CHOICES))
        if self.empty_cells == "zero":
            yield "empty cells are 0"


class DhTableSpec(TablePartSpec):
    """The Denavit-Hartenberg table of the robot.

    Where ``frames`` are the student's choice, the base frame, the tool frame and the joints'
    positive directions may be, too.
    """

    pasted_as = "table"

    kind: Literal["dh_table"]
    convention: Convention | Literal["either"]
    """"standard" (distal) or "modified" (proximal); with "either" the answer says which it
    uses, and one that does not is read in the convention that fits it best."""
    frames: GivenOrFree = "given"
    """Whose choice the frames on the joints are: "given" accepts those of the reference only,
    "free" every valid choice."""
    base: GivenOrFree = "given"
    """Whose choice the base frame is."""
    tool: GivenOrFree = "given"
    """Whose choice the tool frame is."""
    directions: GivenOrFree = "given"
    """Whose choice the positive direction of each joint is."""
    empty_cells: EmptyCells = "unread"
    """Whether a cell that is empty or holds a dash is "unread" and earns nothing, or "zero"."""

    def shape(self, reference: Reference | None) -> DhTableShape:
        """The columns and the row labels of the table."""
        assert isinstance(reference, Robot)
        if isinstance(self.convention, Convention):
            labels = reference.tables[self.convention].labels
        else:
            labels = max((table.labels for table in reference.tables.values()), key=len)
        chosen = self.model_dump(include=_CHOICES)
        return DhTableShape(
            columns=list(COLUMNS),
            rows=list(labels),
            convention=self.convention,
            empty_cells=self.empty_cells,
            **chosen,
        )

    @model_validator(mode="after")
    def _choices_go_together(self) -> "DhTableSpec":
        free = [name for name in ("base", "tool", "directions") if getattr(self, name) == "free"]
        if self.frames == "given" and free:
            raise ValueError(
                f'{free[0]} = "free" says nothing where frames = "given"; '
                f'write frames = "free" or leave {free[0]} out'
            )
        return self
