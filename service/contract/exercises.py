"""The bodies that list and describe exercises, without their answers."""

from pydantic import BaseModel, Field

from service.catalogue import FeedbackLevel
from service.catalogue.files.fields import Marking
from service.catalogue.parts import AnyShape
from service.expressions import Kind


class PartSummary(BaseModel):
    """A part in the list of exercises."""

    id: str
    kind: str = Field(description="The answer kind.")
    points: float


class ExerciseSummary(BaseModel):
    """An exercise in the list."""

    id: str
    title: str
    source: str
    structure: str | None = Field(
        description="The joints in order: R turns, P slides. Null without a robot."
    )
    parts: list[PartSummary]


class ExerciseList(BaseModel):
    """The catalogue."""

    exercises: list[ExerciseSummary]


class SymbolView(BaseModel):
    """A symbol that answers may contain."""

    name: str
    kind: Kind
    unit: str
    description: str
    joint: int | None = Field(None, description="The joint's number if it is a joint variable.")


class PartView(BaseModel):
    """A part without its answer."""

    id: str
    title: str
    prompt: str = Field(description="Markdown, with LaTeX between dollars.")
    prompt_html: str = Field(description="The prompt as HTML and MathML, like `statement_html`.")
    kind: str = Field(description="The answer kind.")
    points: float
    marking: Marking = Field(description="How points are distributed over the cells.")
    follows: str | None = Field(
        None, description="The earlier part that this part follows from; absent if none."
    )
    shape: AnyShape


class ExerciseView(BaseModel):
    """An exercise without its answers."""

    id: str
    version: str
    title: str
    source: str
    structure: str | None = Field(
        None, description="The joints in order: R turns, P slides. Absent without a robot."
    )
    statement: str = Field(description="Markdown, with LaTeX between dollars.")
    statement_html: str = Field(
        description="The statement as HTML and MathML, without scripts, styles and pictures."
    )
    figure: bool = Field(description="True if the exercise has a robot, which `figure.svg` draws.")
    feedback: FeedbackLevel = Field(
        description="The highest feedback level: `full`, `hints`, `verdicts` or `score`."
    )
    symbols: list[SymbolView]
    parts: list[PartView]
