"""Tokens of learners: JSON Web Tokens, signed with the secret of the installation (HS256).

A token is not kept anywhere. It names the key that made it, and is valid as long as this key is.
"""

from datetime import datetime
from typing import Final, NamedTuple

import jwt

from service.access.caller import Caller, Scope
from service.access.keys import CredentialError

_ALGORITHM: Final = "HS256"
_ISSUER: Final = "dh-grader"
_NEEDED: Final = ["exp", "iss", "sub", "key", "scope"]


class LearnerToken(NamedTuple):
    """What a token says; ``exercises`` are None for all those of its key."""

    key_id: str
    learner: str
    scopes: frozenset[Scope]
    exercises: frozenset[str] | None

    def caller(self, holder: Caller) -> Caller:
        """Who brings it, where ``holder`` has the key that made it: never more than the key may."""
        exercises = self.exercises
        if exercises is not None and holder.exercises is not None:
            exercises &= holder.exercises
        return Caller(
            self.scopes & holder.scopes,
            holder.exercises if exercises is None else exercises,
            self.learner,
            self.key_id,
        )


def signed(token: LearnerToken, expires_at: datetime, secret: bytes) -> str:
    """The token as text."""
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
    """What a token says that this installation has signed. Raises CredentialError."""
    try:
        claims = jwt.decode(
            text, secret, [_ALGORITHM], issuer=_ISSUER, options={"require": _NEEDED}
        )
    except jwt.ExpiredSignatureError as error:
        raise CredentialError("The token has expired.") from error
    except jwt.InvalidTokenError as error:
        raise CredentialError("This is no key and no token of this service.") from error
    exercises = claims.get("exercises")
    return LearnerToken(
        claims["key"],
        claims["sub"],
        frozenset(map(Scope, claims["scope"].split())),
        None if exercises is None else frozenset(exercises),
    )
