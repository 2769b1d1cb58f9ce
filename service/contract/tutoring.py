"""The bodies of requests with which tutors change recorded attempts or get tokens for learners."""

from datetime import datetime
from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StringConstraints

from service.contract.attempts import Learner

# The longest validity, which limits the damage of a lost token. A course page renews its token.
LONGEST_MINUTES: Final = 8 * 60

_ExerciseId = Annotated[str, StringConstraints(min_length=1, max_length=100)]
_Apply = Annotated[
    StrictBool, Field(description="If true, apply the change; otherwise only preview it.")
]
_Line = StringConstraints(
    strip_whitespace=True, min_length=1, pattern=r"^[^\x00-\x1f\x7f\u2028\u2029]+$"
)


class OverrideRequest(BaseModel):
    """Points that override those of an attempt's report."""

    model_config = ConfigDict(extra="forbid")

    points: Annotated[float, Field(strict=True, ge=0, allow_inf_nan=False)] | None = Field(
        None,
        description="The new points, from 0 to `max_points`. Omit them to withdraw an earlier "
        "override.",
    )
    reason: Annotated[str, _Line, Field(max_length=1000)] = Field(
        description="The reason in one line. The learner does not see it."
    )
    author: Annotated[str, _Line, Field(max_length=150)] | None = Field(
        None, description="The author of the override. The id of the key is always recorded."
    )


class ForgetRequest(BaseModel):
    """A request to delete all records of a learner."""

    model_config = ConfigDict(extra="forbid")

    learner: Learner
    apply: _Apply = False


class ForgottenData(BaseModel):
    """The number of records of a learner; `deleted` is true after they were deleted."""

    learner: str
    deleted: bool
    attempts: int
    earlier_reports: int
    overrides: int = Field(description="Points that tutors gave or withdrew.")
    courses: int = Field(description="The courses in which the learner is.")
    erased: bool | None = Field(
        None,
        description="True if the deleted data is no longer in SQLite's files. If false, another "
        "program is reading the database; the service overwrites the data within a minute after "
        "that program has ended. Absent if nothing was to be deleted, and with PostgreSQL.",
    )


class RegradeRequest(BaseModel):
    """A request for one step of a regrade."""

    model_config = ConfigDict(extra="forbid")

    apply: _Apply = False
    force: StrictBool = Field(
        False, description="Apply the change although the exercise fails its check."
    )
    cursor: Annotated[str, Field(max_length=60)] | None = Field(
        None, description="The `next` of the previous step; omit it in the first step."
    )


class CountedChange(BaseModel):
    """The points of an attempt in its assignment, as the gradebook has them."""

    before: float = Field(description="The old points.")
    after: float = Field(description="The new points.")
    max_points: float = Field(description="The points of the exercise in the assignment.")
    awarded: float | None = Field(
        None, description="The points that a tutor gave instead, if any: they stay and count."
    )


class AttemptChange(BaseModel):
    """An attempt whose points or results change. Its points are those of the exercise file."""

    id: str
    learner: str
    ordinal: int | None = None
    before: float = Field(description="The old points.")
    after: float = Field(description="The new points.")
    max_points: float
    awarded: float | None = Field(
        None, description="The points that a tutor gave instead, if any: they stay and count."
    )
    reasons: list[str] = Field(
        description="The parts whose results change. Empty if only the points for a late attempt "
        "change."
    )
    counted: CountedChange | None = Field(
        None, description="The same points in the assignment, if one sets the exercise."
    )


class RegradeAnswer(BaseModel):
    """The result of one step of a regrade."""

    applied: bool
    regraded: int = Field(description="The number of attempts in this step.")
    left: int = Field(description="The number of attempts left after this step.")
    changes: list[AttemptChange] = Field(description="The attempts of this step that change.")
    failures: list[str] | None = Field(
        None,
        description="Why the exercise fails `dh-grader exercises check`; in the first step, if it "
        "does.",
    )
    next: str | None = Field(
        None, description="The `cursor` of the next step; absent after the last step."
    )


class TokenRequest(BaseModel):
    """A request for a token of a learner."""

    model_config = ConfigDict(extra="forbid")

    learner: Learner
    exercises: Annotated[list[_ExerciseId], Field(min_length=1, max_length=64)] | None = Field(
        None, description="The exercises of the token. Default: all exercises of the key."
    )
    minutes: int = Field(60, ge=1, le=LONGEST_MINUTES, description="The validity in minutes.")


class TokenResponse(BaseModel):
    """A token, for the header `Authorization: Bearer`."""

    token: str
    learner: str
    expires_at: datetime
