"""The bodies of requests for tokens."""

from datetime import datetime
from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from service.contract.attempts import Learner

# The longest validity, which limits the damage of a lost token. A course page renews its token.
LONGEST_MINUTES: Final = 8 * 60

_ExerciseId = Annotated[str, StringConstraints(min_length=1, max_length=100)]


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
