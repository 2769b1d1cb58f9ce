"""The body of an attempt, and the attempt as recorded."""

from datetime import datetime
from typing import Annotated, Any, Final

from pydantic import BaseModel, Field, StringConstraints

from service.grading import Report
from service.submissions.body import GradeRequest

# Characters that nobody sees, or that a list shows as one and the same sign (Unicode: controls,
# format characters, blanks but the common one, default ignorables, private use, specials).
_UNSEEN: Final = (
    r"\u0000-\u001f\u007f-\u00a0\u00ad\u034f\u0600-\u0605\u061c\u06dd\u070f\u0890-\u0891\u08e2"
    r"\u115f-\u1160\u1680\u17b4-\u17b5\u180b-\u180f\u2000-\u200f\u2028-\u202f\u205f-\u206f\u2800"
    r"\u3000\u3164\ue000-\uf8ff\ufe00-\ufe0f\ufeff\uffa0\ufff0-\uffff"
    # Regular expressions have no common escape for these.
    "\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a"
    "\U000e0000-\U0010ffff"
)
_WORD: Final = f"[^ {_UNSEEN}]+"
# Two learners are never shown alike: single blanks stand between words alone.
Learner = Annotated[
    str,
    StringConstraints(min_length=1, max_length=200, pattern=f"^{_WORD}( {_WORD})*$"),
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
