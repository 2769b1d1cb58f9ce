"""Answer kind ``dh_table``: a Denavit-Hartenberg table of the robot."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal, TypeAlias

from pydantic import Field, model_validator

from service.catalogue.files.fields import GivenOrFree, NotBool
from service.catalogue.part import TablePartSpec
from service.catalogue.robots.formulas import FieldError
from service.catalogue.robots.robot import ReferenceTable, Robot
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.shapes import AnswerShape, choices
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention
from service.translations import say

# The meaning of an empty cell: unread, or 0.
EmptyCells: TypeAlias = Literal["unread", "zero"]

_CHOICES = {"frames", "base", "tool", "directions"}


class DhTableShape(AnswerShape):
    """The shape of a table, and which of its frames are given or free."""

    posted: ClassVar[str] = '`{"rows": [{"a", "alpha", "d", "theta"}, …]}`'

    form: Literal["dh_table"] = "dh_table"
    columns: list[str]
    rows: list[str] = Field(
        description="Row labels in order: joint numbers, `e` for the end effector. If either "
        "convention is accepted, those of the longer table."
    )
    convention: Convention | Literal["either"]
    frames: GivenOrFree
    base: GivenOrFree
    tool: GivenOrFree
    directions: GivenOrFree
    empty_cells: EmptyCells
    given: dict[str, list[str]] = Field(
        default_factory=dict,
        description="The cells of the given rows, by row label, in the order of the columns. An "
        "answer may leave these rows out; they earn nothing.",
    )

    def _clauses(self) -> Iterator[str]:
        rows, columns = ", ".join(self.rows), ", ".join(self.columns)
        yield f"a table with the rows {rows} and the columns {columns}"
        yield f"{self.convention} convention"
        yield from choices(**self.model_dump(include=_CHOICES))
        if self.given:
            named = "row" if len(self.given) == 1 else "rows"
            yield f"{named} {', '.join(self.given)} given"
        if self.empty_cells == "zero":
            yield "empty cells are 0"


class DhTableSpec(TablePartSpec):
    """The Denavit-Hartenberg table of the robot.

    If ``frames`` are free, the base frame, the tool frame and the positive directions of the joints
    may be free, too.
    """

    pasted_as = "table"

    kind: Literal["dh_table"]
    convention: Convention | Literal["either"]
    """"standard" (distal) or "modified" (proximal). With "either", the answer names its
    convention, or else the one that fits it best is used."""
    frames: GivenOrFree = "given"
    """The link frames: "given" accepts only those of the reference, "free" every valid choice."""
    base: GivenOrFree = "given"
    """The base frame: "given" or "free"."""
    tool: GivenOrFree = "given"
    """The tool frame: "given" or "free"."""
    directions: GivenOrFree = "given"
    """The positive directions of the joints: "given" or "free"."""
    empty_cells: EmptyCells = "unread"
    """The meaning of an empty cell or a dash: "unread" earns nothing, "zero" means 0."""
    given: tuple[Annotated[int, Field(ge=1, strict=True), NotBool], ...] = ()
    """The rows that are given, counted from 1, such as [1, 2]. The form shows them filled in. They
    earn nothing: the other rows share the points."""

    def check_reference(self, field: str, reference: Reference | None) -> None:
        """Raise FieldError if the file gives a row that the robot's table does not have."""
        super().check_reference(field, reference)
        if not self.given:
            return
        assert isinstance(reference, Robot)
        if self.convention is not reference.convention:
            raise FieldError(
                f"{field}.given",
                say(
                    "are rows of the robot's own table, which is {convention}; write convention "
                    '= "{convention}"',
                    convention=reference.convention.value,
                ),
            )
        rows = len(reference.tables[reference.convention].rows)
        if max(self.given) > rows or len(self.given) == rows:
            raise FieldError(
                f"{field}.given",
                say("leave at least one of the {rows} rows to the student", rows=rows),
            )

    def shape(self, reference: Reference | None) -> DhTableShape:
        """The shape of the table in the convention of the part."""
        assert isinstance(reference, Robot)
        labels = self.asked_table(reference).labels
        chosen = self.model_dump(include=_CHOICES)
        return DhTableShape(
            columns=list(COLUMNS),
            rows=list(labels),
            convention=self.convention,
            empty_cells=self.empty_cells,
            given=self._given_cells(reference),
            **chosen,
        )

    def asked_table(self, robot: Robot) -> ReferenceTable:
        """Return the robot's table in the part's convention."""
        if isinstance(self.convention, Convention):
            return robot.tables[self.convention]
        # The part accepts both conventions.
        return max(robot.tables.values(), key=lambda table: len(table.rows))

    def _given_cells(self, robot: Robot) -> dict[str, list[str]]:
        table = robot.tables[robot.convention]
        return {
            table.labels[i - 1]: [cell.source for cell in table.rows[i - 1]] for i in self.given
        }

    @model_validator(mode="after")
    def _given_rows_have_given_frames(self) -> "DhTableSpec":
        if list(self.given) != sorted(set(self.given)):
            raise ValueError(say("write each number in given once, in order"))
        if self.given and self.frames == "free":
            raise ValueError(
                say('given rows need frames = "given", because they say where frames lie')
            )
        return self

    @model_validator(mode="after")
    def _choices_go_together(self) -> "DhTableSpec":
        free = [name for name in ("base", "tool", "directions") if getattr(self, name) == "free"]
        if self.frames == "given" and free:
            raise ValueError(
                say(
                    '{name} = "free" says nothing where frames = "given"; write frames = "free" '
                    "or leave {name} out",
                    name=free[0],
                )
            )
        return self
