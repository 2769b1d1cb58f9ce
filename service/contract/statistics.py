"""The statistics of an exercise, as tutors get them."""

from pydantic import BaseModel, Field


class ShareCorrect(BaseModel):
    """How many were right, of those who answered."""

    answered: int = Field(description="Answers; what could not be read is one.")
    correct: int
    share: float | None = Field(None, description="correct / answered; left out where nobody did.")


class CellFigures(ShareCorrect):
    """A cell in all attempts."""

    label: str


class RowFigures(ShareCorrect):
    """A row in all attempts: right where all its cells are."""

    label: str
    cells: list[CellFigures]


class PartFigures(ShareCorrect):
    """A part in all attempts."""

    part: str
    rows: list[RowFigures]


class MisconceptionFigures(BaseModel):
    """A code of a message in a part."""

    part: str
    code: str
    sentence: str | None = Field(
        None,
        description="What one of them was told; left out where the report told no more than marks.",
    )
    attempts: int = Field(description="The attempts that have it.")
    by_day: dict[str, int] = Field(description="The same by day, in UTC.")


class IdenticalAnswers(BaseModel):
    """Wrong answers that several learners sent letter by letter; no proof that anybody copied."""

    learners: int
    attempts: int
    wrong: list[str] = Field(description="The wrong places: part/row/cell.")
    among: list[str] = Field(description="The first of these learners, in alphabetical order.")


class ExerciseStatistics(BaseModel):
    """The attempts at an exercise in counts."""

    exercise: str
    attempts: int
    learners: int
    parts: list[PartFigures]
    misconceptions: list[MisconceptionFigures] = Field(description="The commonest first.")
    identical: list[IdenticalAnswers] = Field(description="The largest groups first.")
