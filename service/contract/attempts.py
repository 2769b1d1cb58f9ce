"""The body of an attempt, and the attempt as recorded."""

from datetime import datetime
from typing import Annotated

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
