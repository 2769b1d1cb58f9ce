"""The exercises as they are listed and described: everything but the answers."""

from pydantic import BaseModel, Field

from service.catalogue import FeedbackLevel
from service.catalogue.files.fields import Marking
from service.catalogue.parts import AnyShape
from service.expressions import Kind


class PartSummary(BaseModel):
    """A part in the list of exercises."""

    id: str
    kind: str = Field(description="The kind of answer that it asks for.")
    points: float


class ExerciseSummary(BaseModel):
    """An exercise in the list."""

    id: str
    title: str
    source: str
    structure: str | None = Field(
        description="The joints in order: R turns, P slides. Null where there is no robot."
    )
    parts: list[PartSummary]


class ExerciseList(BaseModel):
    """The catalogue."""

    exercises: list[ExerciseSummary]


class SymbolView(BaseModel):
    """A letter that may stand in an answer."""

    name: str
    kind: Kind
    unit: str
    description: str
    joint: int | None = Field(None, description="The joint whose variable this is.")


class PartView(BaseModel):
    """A part as a student sees it before answering."""

    id: str
    title: str
    prompt: str = Field(description="Markdown, with LaTeX between dollars.")
    prompt_html: str = Field(description="The same as HTML and MathML, like the statement.")
    kind: str = Field(description="The kind of answer that it asks for.")
    points: float
    marking: Marking = Field(description="How the cells of an answer share its points.")
    follows: str | None = Field(
        None,
        description="The earlier part that this one follows from; left out where there is none.",
    )
    shape: AnyShape


class ExerciseView(BaseModel):
    """An exercise as a student sees it before answering."""

    id: str
    version: str
    title: str
    source: str
    structure: str | None = Field(None, description="Left out where there is no robot.")
    statement: str = Field(description="Markdown, with LaTeX between dollars.")
    statement_html: str = Field(
        description="The same as HTML and MathML, without scripts, styles and pictures."
    )
    figure: bool = Field(description="Whether it has a robot that `figure.svg` draws.")
    feedback: FeedbackLevel = Field(
        description="The most that a report on it tells: `full`, `hints`, `verdicts` or `score`."
    )
    symbols: list[SymbolView]
    parts: list[PartView]
