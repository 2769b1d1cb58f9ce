"""The bodies by which tutors change what is recorded."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StringConstraints

from service.contract.attempts import Learner

_Apply = Annotated[
    StrictBool, Field(description="Whether to do it; without it, only what it would do is told.")
]
_Line = StringConstraints(
    strip_whitespace=True, min_length=1, pattern=r"^[^\x00-\x1f\x7f\u2028\u2029]+$"
)


class OverrideRequest(BaseModel):
    """Points in place of those of an attempt's report."""

    model_config = ConfigDict(extra="forbid")

    points: Annotated[float, Field(strict=True, ge=0, allow_inf_nan=False)] | None = Field(
        None,
        description="From 0 to the most that the attempt may have. Left out, those that were given "
        "earlier are withdrawn.",
    )
    reason: Annotated[str, _Line, Field(max_length=1000)] = Field(
        description="Why, in a line. The learner does not read it."
    )
    author: Annotated[str, _Line, Field(max_length=150)] | None = Field(
        None, description="Who says so. The id of the key is noted in any case."
    )


class ForgetRequest(BaseModel):
    """The learner of whom nothing is to be kept."""

    model_config = ConfigDict(extra="forbid")

    learner: Learner
    apply: _Apply = False


class ForgottenData(BaseModel):
    """How much is recorded of a learner, or was until it was deleted."""

    learner: str
    deleted: bool
    attempts: int
    earlier_reports: int
    overrides: int = Field(description="Points that tutors gave, or withdrew.")
    erased: bool | None = Field(
        None,
        description="Whether the files of SQLite hold none of it any more. If not, another program "
        "is reading the database; the service overwrites it within a minute after that has ended. "
        "Left out where nothing was to be deleted, and with PostgreSQL.",
    )


class RegradeRequest(BaseModel):
    """A step of a regrade."""

    model_config = ConfigDict(extra="forbid")

    apply: _Apply = False
    cursor: Annotated[str, Field(max_length=60)] | None = Field(
        None, description="The `next` of the step before; left out at the first one."
    )


class AttemptChange(BaseModel):
    """An attempt whose learner gets another report, or other points by it."""

    id: str
    learner: str
    ordinal: int | None = None
    before: float = Field(description="The points so far.")
    after: float
    max_points: float
    awarded: float | None = Field(
        None, description="The points that a tutor gave instead, if any: they stay and count."
    )
    reasons: list[str] = Field(
        description="The parts that are judged otherwise. None where only the worth of a late "
        "attempt is another."
    )


class RegradeAnswer(BaseModel):
    """What one step of a regrade has graded anew."""

    applied: bool
    regraded: int = Field(description="The attempts of this step.")
    left: int = Field(description="The attempts that wait after it.")
    changes: list[AttemptChange] = Field(description="Those of this step that change.")
    next: str | None = Field(
        None, description="The `cursor` of the next step; left out where nothing waits."
    )
