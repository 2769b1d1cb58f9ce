"""The bodies of the statistics of an exercise."""

from pydantic import BaseModel, Field

from service.contract.preview import ToldText


class ShareCorrect(BaseModel):
    """The number of answers and of right answers."""

    answered: int = Field(description="The number of answers, including unreadable ones.")
    correct: int
    share: float | None = Field(None, description="correct / answered; absent without answers.")


class CellFigures(ShareCorrect):
    """The figures of a cell in all attempts."""

    label: str


class RowFigures(ShareCorrect):
    """The figures of a row in all attempts. A row is right if all its cells are."""

    label: str
    cells: list[CellFigures]


class PartFigures(ShareCorrect):
    """The figures of a part in all attempts."""

    part: str
    rows: list[RowFigures]


class MisconceptionFigures(BaseModel):
    """The figures of a message code in a part."""

    part: str
    code: str
    sentence: ToldText | None = Field(
        None,
        description="The message in one of these reports; absent if the report has no messages.",
    )
    attempts: int = Field(description="The number of attempts with this code.")
    by_day: dict[str, int] = Field(description="The number of these attempts by day, in UTC.")
    by_attempt: list[int] = Field(
        [],
        description="The number of learners with this code in their first attempt, in their "
        "second one, and so on. `learners_by_attempt` has the numbers of all learners.",
    )


class HintFigures(BaseModel):
    """How often learners took the hints for the messages of a code, at recorded attempts."""

    part: str
    code: str
    taken: list[int] = Field(description="The number of times for each of the three steps.")


class IdenticalAnswers(BaseModel):
    """Exactly equal wrong answers of several learners. They do not prove that anybody copied."""

    learners: int
    attempts: int
    wrong: list[str] = Field(description="The wrong places: part/row/cell.")
    among: list[str] = Field(description="The first of these learners, in alphabetical order.")


class ExerciseStatistics(BaseModel):
    """The statistics of the attempts at an exercise."""

    exercise: str
    attempts: int
    learners: int
    parts: list[PartFigures]
    misconceptions: list[MisconceptionFigures] = Field(description="The most common ones first.")
    learners_by_attempt: list[int] = Field(
        [],
        description="The number of learners who made a first attempt, a second one, and so on.",
    )
    hints: list[HintFigures] = Field([], description="The hints most often taken first.")
    identical: list[IdenticalAnswers] = Field(description="The largest groups first.")
