"""The body of an attempt, and the attempt as recorded."""

from datetime import datetime
from typing import Annotated, Any

from pydantic import BaseModel, Field, StringConstraints

from service.grading import Report
from service.submissions.body import GradeRequest

Learner = Annotated[
    str,
    StringConstraints(min_length=1, max_length=200, pattern=r"^[^\x00-\x1f\x7f]+$"),
    Field(
        description="Who hands in, as the course names its learners; better an opaque id than a "
        "name. Nothing but equality is made of it."
    ),
]


class AttemptRequest(GradeRequest):
    """Answers to an exercise, to be recorded."""

    learner: Learner


class Attempt(BaseModel):
    """A recorded attempt."""

    id: str
    exercise: str
    learner: str
    ordinal: int | None = Field(
        None,
        description="Which of the learner's attempts it is, from 1. Left out where nothing could "
        "be read: such an attempt does not count.",
    )
    at: datetime
    is_late: bool
    points: float = Field(description="The report's points, or the share that a late one earns.")
    max_points: float


class AttemptResponse(BaseModel):
    """The attempt as recorded, and its report."""

    attempt: Attempt
    report: Report


class AttemptSummary(Attempt):
    """A recorded attempt as tutors see it in a list."""

    awarded: float | None = Field(
        None, description="The points that a tutor has given instead, where one has."
    )
    version: str = Field(description="The version of the exercise that it was graded by.")
    grader: str = Field(description="The version of the program that graded it.")


class AttemptList(BaseModel):
    """Recorded attempts, the newest first."""

    attempts: list[AttemptSummary]
    next: str | None = Field(
        None, description="The `cursor` of the next page; left out on the last one."
    )


class AttemptOverride(BaseModel):
    """Points that a tutor has given instead of the report's."""

    points: float | None = Field(None, description="Left out where earlier ones were withdrawn.")
    reason: str
    author: str
    at: datetime


class EarlierReport(BaseModel):
    """A report that a regrade has replaced."""

    replaced_at: datetime
    version: str
    grader: str
    points: float
    max_points: float
    report: Report


class AttemptDetail(BaseModel):
    """A recorded attempt with its answers and all its reports."""

    attempt: AttemptSummary
    submission: dict[str, Any] = Field(description="What was sent, without the learner.")
    report: Report
    overrides: list[AttemptOverride] = Field(description="The oldest first.")
    earlier_reports: list[EarlierReport] = Field(description="The oldest first.")
