"""The bodies of routes about the scores that are sent to learning platforms."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from service.contract.attempts import Learner
from service.contract.courses import CourseName

ScoreState = Literal["waiting", "sent", "refused"]


class PlatformScore(BaseModel):
    """The score of a learner in an assignment, at one link of a platform."""

    learner: str
    name: str = Field(description="The name of the learner in the course.")
    assignment: str
    link: str = Field(description="The title of the link at the platform.")
    state: ScoreState = Field(description="Whether the platform has the score of now.")
    sent_points: float | None = Field(None, description="The points that the platform has.")
    sent_at: datetime | None = Field(None, description="When it was sent.")
    max_points: float
    tries: int = Field(description="How often it was tried since it was sent last.")
    next_try_at: datetime | None = Field(None, description="When a waiting score is sent.")
    problem: str | None = Field(None, description="Why it was not sent, or was refused.")


class PlatformScores(BaseModel):
    """The scores of a course that go to platforms."""

    scores: list[PlatformScore]


class SendAgainRequest(BaseModel):
    """Which scores to send again."""

    model_config = ConfigDict(extra="forbid")

    assignment: CourseName | None = Field(None, description="Only those of this assignment.")
    learner: Learner | None = Field(None, description="Only those of this learner.")
    failed: bool = Field(False, description="Only those that were refused, or tried in vain.")


class SentAgain(BaseModel):
    """How many scores are sent again."""

    queued: int
