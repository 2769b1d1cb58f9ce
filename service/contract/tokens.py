"""The bodies by which learners get tokens."""

from datetime import datetime
from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from service.contract.attempts import Learner

# A course page asks for a new one before; a token that is lost is worth no more than this.
LONGEST_MINUTES: Final = 8 * 60

_ExerciseId = Annotated[str, StringConstraints(min_length=1, max_length=100)]


class TokenRequest(BaseModel):
    """Whom a token is for."""

    model_config = ConfigDict(extra="forbid")

    learner: Learner
    exercises: Annotated[list[_ExerciseId], Field(min_length=1, max_length=64)] | None = Field(
        None, description="The exercises that it is for; left out, all those of the key."
    )
    minutes: int = Field(60, ge=1, le=LONGEST_MINUTES, description="How long it is valid.")


class TokenResponse(BaseModel):
    """A token, for the header `Authorization: Bearer`."""

    token: str
    learner: str
    expires_at: datetime
