"""The bodies of requests about grading, about hints, and about alternatives to a correct table."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from service.contract.preview import ToldText
from service.contract.problems import ProblemDocument
from service.grading import Report
from service.hints.steps import STEPS
from service.submissions.body import GradeRequest

_Label = Annotated[str, Field(max_length=40)]


class HintRequest(GradeRequest):
    """Answers, a message of their report, and the step of its hint."""

    part: _Label = Field(description="The id of the part that the message is on.")
    code: _Label = Field(description="The code of the message.")
    row: _Label | None = Field(
        None, description="The row of the message or of one of its places; absent if it has none."
    )
    cell: _Label | None = Field(
        None, description="The cell of the message or of one of its places; absent if it has none."
    )
    step: Annotated[int, Field(strict=True, ge=1, le=STEPS)] = Field(
        description="1: what to look at. 2: the rule, with its picture. 3: the rule on this row."
    )


class Hint(BaseModel):
    """One step of a hint."""

    step: int
    steps: int = Field(description="The number of steps of each hint.")
    title: ToldText = Field(description="The name of the rule.")
    text: ToldText
    picture: str | None = Field(
        None,
        description="The path of the picture of the rule, an SVG, from the address of the service. "
        "`text` says the same in words. Absent in other steps, and if the rule has no picture.",
    )
    lesson: str | None = Field(
        None,
        description="The path of the page that explains the rule, from the address of the service. "
        "Absent in other steps, and if no page does.",
    )


_Formula = Annotated[str, Field(max_length=200)]


class TableRow(BaseModel):
    """A row of a table: the formulas of its cells."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    a: _Formula
    alpha: _Formula
    d: _Formula
    theta: _Formula


class ChoicesRequest(BaseModel):
    """A right table of the robot."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    part: _Label = Field(description="The id of the part that the table answers.")
    rows: Annotated[list[TableRow], Field(max_length=12)]
    angle_unit: Literal["radians", "degrees"] = Field(
        "radians", description="The unit of angles without a unit."
    )


class ValidTable(BaseModel):
    """A correct table that differs from the submitted one in one frame."""

    change: ToldText = Field(description="What is different in it, as a sentence.")
    rows: list[TableRow]


class FrameChoices(BaseModel):
    """At most three alternatives to a correct table; none if the frames are given."""

    choices: list[ValidTable]


class GradeResult(BaseModel):
    """The report on one submission, or a problem."""

    report: Report | None = None
    problem: ProblemDocument | None = Field(
        None,
        description="The problem that the submission would get in a request of its own; `instance` "
        "is its place in this request.",
    )


class GradeManyResponse(BaseModel):
    """The results in the order of the submissions."""

    results: list[GradeResult]
