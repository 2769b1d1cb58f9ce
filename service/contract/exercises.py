"""The bodies that list and describe exercises and generated robots, without their answers."""

from pydantic import BaseModel, Field

from service.catalogue import ExerciseLevel, FeedbackLevel
from service.catalogue.files.fields import Marking
from service.catalogue.parts import AnyShape
from service.expressions import Kind
from service.kinematics.dh import Convention


class PartSummary(BaseModel):
    """A part in the list of exercises."""

    id: str
    kind: str = Field(description="The answer kind.")
    points: float


class CatalogueEntry(BaseModel):
    """What the catalogue says about an exercise."""

    id: str
    title: str
    source: str
    level: ExerciseLevel | None = Field(
        None, description="The level: `start`, `basics`, `arms` or `industrial`."
    )
    order: int | None = Field(None, description="The place within the level.")
    minutes: int | None = Field(None, description="The minutes that a student needs.")
    summary: str = Field("", description="One line about the exercise.")
    conventions: list[Convention] = Field(
        [], description="The DH conventions that the parts ask for."
    )
    keywords: list[str] = Field([], description="More words for a search.")


class ExerciseSummary(CatalogueEntry):
    """An exercise in the list."""

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


class ExerciseView(CatalogueEntry):
    """An exercise without its answers."""

    version: str
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


class PracticeRobot(BaseModel):
    """A generated robot. Its exercise is found by its id like any other."""

    id: str = Field(description="The id of the exercise.", examples=["practice-2-standard~k3f9"])
    level: int
    convention: Convention
    difficulty: int = Field(
        description="Counted: joints, changes of direction, offsets, sliding joints, free choices, "
        "twists other than 90°."
    )
