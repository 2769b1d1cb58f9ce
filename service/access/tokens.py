"""Tokens of learners: JSON Web Tokens, signed with the secret of the installation.

A token names a key and is valid at most as long as the key. Tokens are not stored.
"""

import time
from datetime import datetime
from typing import Annotated, Final, Literal, NamedTuple

import jwt
from pydantic import BaseModel, ConfigDict, StringConstraints, ValidationError

from service.access.caller import Caller, Scope
from service.access.keys import CredentialError
from service.contract.attempts import Learner
from service.translations import say

_ALGORITHM: Final = "HS256"
_ISSUER: Final = "dh-grader"
_JWS: Final = jwt.PyJWS()


class _Claims(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    iss: Literal["dh-grader"]
    sub: Learner
    # The id of a key: it is looked up in the database.
    key: Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{8}$")]
    scope: str
    exp: int
    exercises: list[str] | None = None


class LearnerToken(NamedTuple):
    """The content of a token; ``exercises`` is None for all exercises of its key."""

    key_id: str
    learner: str
    scopes: frozenset[Scope]
    exercises: frozenset[str] | None

    def caller(self, holder: Caller) -> Caller:
        """Return the caller with this token, with at most the rights of the key's holder."""
        exercises = self.exercises
        if exercises is not None and holder.exercises is not None:
            exercises &= holder.exercises
        return Caller(
            self.scopes & holder.scopes,
            holder.exercises if exercises is None else exercises,
            self.learner,
            self.key_id,
            holder.course,
        )


def signed(token: LearnerToken, expires_at: datetime, secret: bytes) -> str:
    """Return the text of a signed token."""
    claims = {
        "iss": _ISSUER,
        "sub": token.learner,
        "key": token.key_id,
        "scope": " ".join(sorted(token.scopes)),
        "exp": int(expires_at.timestamp()),
    }
    if token.exercises is not None:
        claims["exercises"] = sorted(token.exercises)
    return jwt.encode(claims, secret, _ALGORITHM)


def verified(text: str, secret: bytes) -> LearnerToken:
    """Return the content of a token with a valid signature. Raises CredentialError."""
    try:
        claims = _Claims.model_validate_json(_JWS.decode(text, secret, [_ALGORITHM]))
        scopes = frozenset(map(Scope, claims.scope.split()))
    except jwt.InvalidTokenError as error:
        raise CredentialError(say("This is neither a key nor a token of this service.")) from error
    except ValidationError as error:
        wrong = {str(detail["loc"][0]) if detail["loc"] else "" for detail in error.errors()}
        named = [name for name in _Claims.model_fields if name in wrong] or ["others"]
        raise CredentialError(_unexpected(*named)) from error
    except ValueError as error:
        raise CredentialError(_unexpected("scope")) from error
    if claims.exp <= time.time():
        raise CredentialError(say("The token has expired."))
    exercises = None if claims.exercises is None else frozenset(claims.exercises)
    return LearnerToken(claims.key, claims.sub, scopes, exercises)


def _unexpected(*claims: str) -> str:
    return f"The token has unexpected claims: {', '.join(claims)}."
