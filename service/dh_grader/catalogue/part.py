"""What all answer kinds have in common in a file, and the shape of an answer."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic import BaseModel, Field, StrictBool, model_validator

from dh_grader.catalogue.robot import FieldError, Reference, Robot, WrittenFormulas
from dh_grader.catalogue.schema_fields import (
    FrameName,
    Identifier,
    LooseText,
    Marking,
    NotBool,
    StrictModel,
    Text,
)
from dh_grader.expressions import Kind
from dh_grader.kinematics import Convention
from dh_grader.translations import say

# --- The shape of an answer, which students see before they answer


class AnswerShape(BaseModel, ABC):
    """The shape of an answer. ``form`` names the kind of shape; ``posted`` is its JSON form."""

    posted: ClassVar[str]
    if TYPE_CHECKING:
        form: str

    def in_words(self) -> str:
        """Return the shape in words: "a matrix of 4 rows and 4 columns"."""
        return "; ".join(self._clauses())

    @abstractmethod
    def _clauses(self) -> Iterator[str]: ...


class MatrixShape(AnswerShape):
    """The shape of a matrix."""

    posted: ClassVar[str] = "a list of rows, each a list of entries"

    form: Literal["matrix"] = "matrix"
    columns: list[str]
    rows: list[str]

    def _clauses(self) -> Iterator[str]:
        yield f"a matrix of {len(self.rows)} rows and {len(self.columns)} columns"


class ComponentView(BaseModel):
    """One value of a list: its name and its quantity."""

    name: str
    quantity: Kind


class ListShape(AnswerShape):
    """The shape of a list of values; for Euler angles with their axes in order."""

    posted: ClassVar[str] = "a list of entries"

    form: Literal["list"] = "list"
    rows: list[str]
    components: list[ComponentView]
    sequence: str | None = Field(
        None, description='Axes such as "ZYZ"; "RPY" is Rz(α) Ry(β) Rx(γ).'
    )
    axes: Literal["moving", "fixed"] | None = None

    def _clauses(self) -> Iterator[str]:
        yield f"a list: {', '.join(f'{each.name} ({each.quantity})' for each in self.components)}"
        if self.sequence:
            yield f"{self.sequence} about {self.axes} axes"


def matrix_shape(rows: int, columns: int) -> MatrixShape:
    """Return the shape of a matrix with this number of rows and columns."""
    return MatrixShape(columns=numbered(columns), rows=numbered(rows))


def list_shape(components: Iterable[tuple[str, Kind]]) -> ListShape:
    """Return the shape of a list of values, each with its name and quantity."""
    views = [ComponentView(name=name, quantity=quantity) for name, quantity in components]
    return ListShape(rows=numbered(len(views)), components=views)


def numbered(count: int) -> list[str]:
    """Return the labels "1", "2" and so on."""
    return [str(i + 1) for i in range(count)]


_NAMES = {"base": "base frame", "tool": "tool frame"}


def choices(**stated: str) -> Iterator[str]:
    """Yield phrases such as "frames free" and "tool frame given" from ``stated``."""
    for choice in ("free", "given"):
        names = [_NAMES.get(name, name) for name, value in stated.items() if value == choice]
        if names:
            yield f"{', '.join(names)} {choice}"


# --- The base classes of answer kinds, whose subclasses are in ``kinds.py``


class PartSpec(StrictModel, ABC):
    """A part (one question) of an exercise file.

    Each answer kind is a subclass with ``kind: Literal["its_name"]``.
    """

    # The fields that may give the answer, if it does not come from the robot.
    answer_fields: ClassVar[tuple[str, ...]] = ("expected",)
    # True if a later part can be graded with this answer in place of the robot.
    can_be_followed: ClassVar[bool] = False
    # The content of a pasted answer.
    pasted_as: ClassVar[Literal["table", "numbers", "angles"]] = "numbers"
    # True if the answer contains the link transforms.
    holds_links: ClassVar[bool] = False
    # True if two parts are the same task only with equal formulas, not with equal answers.
    compared_by_formulas: ClassVar[bool] = False

    id: Identifier
    """The name of the part in answers and reports."""
    title: Text
    """The title that students see."""
    prompt: LooseText = ""
    """The task in one or more sentences: Markdown, like the statement."""
    points: Annotated[float, Field(gt=0, le=1000, strict=True), NotBool] = 1.0
    """The points for a right answer; its rows share them."""
    marking: Marking = "content"
    """The way in which points are distributed: "content" by the knowledge that each cell needs
    (a lazy answer earns little), "cells" evenly over the cells, "rows" only to rows that are
    completely right, "whole" only to a completely right answer."""
    follows: Identifier | None = None
    """The id of an earlier part that this one builds on. An answer earns its points if it is right
    for the robot or for the student's own answer to that part."""
    follows_from: Annotated[float, Field(ge=0, le=1, strict=True), NotBool] = 0.5
    """The share of its points that the earlier answer must have earned, so that this part may
    follow from it."""
    if TYPE_CHECKING:
        kind: str

    def formulas(self) -> WrittenFormulas | None:
        """Return the right answer as formulas, or None if it is computed from the robot."""
        return None

    def check_reference(self, field: str, reference: Reference | None) -> None:
        """Raise FieldError if the right answer cannot be computed from the robot.

        ``field`` is the path of the part in the file.
        """
        if reference is None:
            raise FieldError(
                f"{field}.expected",
                say("is required here: the exercise has no robot that would tell it"),
            )

    @abstractmethod
    def shape(self, reference: Reference | None) -> AnswerShape:
        """Return the shape of an answer, such as the size of a matrix."""


class PosePartSpec(PartSpec):
    """A part about the pose of frame ``to`` in frame ``from``, such as its rotation."""

    start: FrameName = Field("base", alias="from")
    """The frame in which the pose is expressed: "base", "tool", or a number of the robot's own
    table."""
    to: FrameName = "tool"
    """The frame whose pose is asked for."""
    home: StrictBool = False
    """True if all joint variables are 0."""

    def check_reference(self, field: str, reference: Reference | None) -> None:
        """Raise FieldError unless the robot has the frames ``from`` and ``to``."""
        super().check_reference(field, reference)
        assert reference is not None
        for name, frame in (("from", self.start), ("to", self.to)):
            if not reference.has_frame(frame):
                known = ", ".join(map(str, reference.frames))
                raise FieldError(
                    f"{field}.{name}",
                    say(
                        "the robot has no frame {frame!r}; it has {known}", frame=frame, known=known
                    ),
                )

    @model_validator(mode="after")
    def _is_given_once(self) -> "PosePartSpec":
        given = [name for name in self.answer_fields if getattr(self, name)]
        names = {"start": "from", "to": "to", "home": "home"}
        further = [name for field, name in names.items() if field in self.model_fields_set]
        if given and given[1:] + further:
            raise ValueError(
                say(
                    "{name} says what is right; leave {other} out",
                    name=given[0],
                    other=(given[1:] + further)[0],
                )
            )
        return self


class TablePartSpec(PartSpec):
    """A part about a DH table of the robot. A robot given by screws has no table."""

    answer_fields: ClassVar[tuple[str, ...]] = ()
    can_be_followed: ClassVar[bool] = True

    if TYPE_CHECKING:
        convention: Convention | str

    def check_reference(self, field: str, reference: Reference | None) -> None:
        """Raise FieldError unless the robot has a table in the convention of the part."""
        if not isinstance(reference, Robot):
            raise FieldError(
                f"{field}.kind",
                say('a "{kind}" needs a robot with a table; write [robot] table', kind=self.kind),
            )
        if isinstance(self.convention, Convention) and self.convention not in reference.tables:
            raise FieldError(
                f"{field}.convention",
                say(
                    "the robot has no {convention} table: its row 1 moves the base frame, and a "
                    "standard table begins on the axis of joint 1",
                    convention=self.convention.value,
                ),
            )
