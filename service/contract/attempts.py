"""The bodies of new and recorded attempts."""

from datetime import datetime
from typing import Annotated, Any, Final

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from service.grading import Report
from service.submissions.body import GradeRequest

# Characters that are invisible or look alike in a list (Unicode: controls, format characters, all
# spaces except U+0020, default ignorables, private use, specials).
_INVISIBLE: Final = (
    r"\u0000-\u001f\u007f-\u00a0\u00ad\u034f\u0600-\u0605\u061c\u06dd\u070f\u0890-\u0891\u08e2"
    r"\u115f-\u1160\u1680\u17b4-\u17b5\u180b-\u180f\u2000-\u200f\u2028-\u202f\u205f-\u206f\u2800"
    r"\u3000\u3164\ue000-\uf8ff\ufe00-\ufe0f\ufeff\uffa0\ufff0-\uffff"
)
# Programs may compile the documented pattern without the flag "u" of JavaScript, which then does
# not understand characters above U+FFFF. So the document has the pattern without them.
_ABOVE: Final = (
    "\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a"
    "\U000e0000-\U0010ffff"
)


def _words(but: str) -> str:
    return f"^[^ {but}]+( [^ {but}]+)*$"


# Words separated by single spaces, so that two different learners never look alike.
Learner = Annotated[
    str,
    StringConstraints(min_length=1, max_length=200, pattern=_words(_INVISIBLE + _ABOVE)),
    Field(
        description="The learner, as the course identifies them; preferably an opaque id instead "
        "of a name. The service only tests it for equality.",
        json_schema_extra={"pattern": _words(_INVISIBLE)},
    ),
]


HintLabel = Annotated[str, StringConstraints(max_length=40, pattern=r"^[^\x00]+$")]


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
        description="The number of the attempt among the learner's counted attempts, from 1. "
        "Absent if nothing could be read: such an attempt does not count.",
    )
    at: datetime
    is_late: bool
    points: float = Field(
        description="The report's points, reduced by the price of hints and for a late attempt."
    )
    max_points: float
    hint_points: float | None = Field(
        None,
        description="The points that the hints cost that the learner took before this attempt; "
        "absent if they cost nothing.",
    )


class AttemptResponse(BaseModel):
    """The recorded attempt and its report."""

    attempt: Attempt
    report: Report


class AttemptSummary(Attempt):
    """A recorded attempt in a tutor's list."""

    awarded: float | None = Field(
        None, description="The points that a tutor has given instead, if any."
    )
    version: str = Field(description="The version of the exercise that graded the attempt.")
    grader: str = Field(description="The version of the program that graded the attempt.")
    variant: str | None = Field(
        None, description="The seed of the variant, for tutors; absent for an exercise without."
    )


class AttemptList(BaseModel):
    """Recorded attempts, the newest first."""

    attempts: list[AttemptSummary]
    next: str | None = Field(
        None, description="The `cursor` of the next page; absent on the last page."
    )


class AttemptOverride(BaseModel):
    """Points that a tutor has given instead of the report's."""

    points: float | None = Field(
        None, description="The new points; absent if an earlier override was withdrawn."
    )
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


class AttemptHintRequest(BaseModel):
    """A message of the report on a recorded attempt, and the step of its hint."""

    model_config = ConfigDict(extra="forbid")

    part: HintLabel = Field(description="The id of the part that the message is on.")
    code: HintLabel = Field(description="The code of the message.")
    row: HintLabel | None = Field(None, description="The row of the message or of its place.")
    cell: HintLabel | None = Field(None, description="The cell of the message or of its place.")
    step: Annotated[int, Field(strict=True, ge=1, le=3)] = Field(
        description="The next step, or one that the learner has taken: it costs nothing again."
    )


class TakenHint(BaseModel):
    """A step of a hint that a learner took at a recorded attempt."""

    attempt: str = Field(description="The id of the attempt with the message.")
    part: str
    code: str
    row: str | None = Field(None, description="The row of the message, if it has one.")
    cell: str | None = Field(None, description="The cell of the message, if it has one.")
    step: int
    price: float = Field(description="The share of the points of the exercise that it costs.")
    at: datetime


class AttemptDetail(BaseModel):
    """A recorded attempt with its answers and all its reports."""

    attempt: AttemptSummary
    submission: dict[str, Any] = Field(description="The request body without the learner.")
    report: Report
    overrides: list[AttemptOverride] = Field(description="The overrides, oldest first.")
    earlier_reports: list[EarlierReport] = Field(description="The old reports, oldest first.")
    hints: list[TakenHint] = Field(
        [], description="The hints that the learner took before this attempt, oldest first."
    )
