"""Sessions of tutors in a browser.

A session is a signed text that names a key. Sessions are not stored.
"""

# A session token is valid at most as long as its key.

import time
from datetime import datetime
from typing import Annotated, Final, Literal

import jwt
from pydantic import BaseModel, ConfigDict, StringConstraints, ValidationError

from service.access.keys import CredentialError
from service.translations import say

_ALGORITHM: Final = "HS256"
_JWS: Final = jwt.PyJWS()


class _SessionClaims(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    iss: Literal["dh-grader session"]
    key: Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{8}$")]
    exp: int


def signed_session(key_id: str, expires_at: datetime, secret: bytes) -> str:
    """Return a session token for the holder of the key ``key_id``."""
    claims = {"iss": "dh-grader session", "key": key_id, "exp": int(expires_at.timestamp())}
    return jwt.encode(claims, secret, _ALGORITHM)


def key_of_session(text: str, secret: bytes) -> str:
    """Return the id of the key that a session token names. Raises CredentialError."""
    try:
        claims = _SessionClaims.model_validate_json(_JWS.decode(text, secret, [_ALGORITHM]))
    except (jwt.InvalidTokenError, ValidationError) as error:
        raise CredentialError(say("This is no session of this service.")) from error
    if claims.exp <= time.time():
        raise CredentialError(say("The session has expired."))
    return claims.key
