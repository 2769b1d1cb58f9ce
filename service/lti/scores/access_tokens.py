"""Get access tokens from platforms (OAuth client credentials)."""

import json
import re
import secrets
from collections.abc import Callable, Mapping
from datetime import datetime, timedelta
from http import HTTPStatus
from typing import Final

import jwt
from sqlalchemy import Engine

from service.access.keys import Secret
from service.attempts.storage.database import in_transaction
from service.lti.fetching import FetchError, answer, content
from service.lti.own_keys import SigningKey, ensure_key, signing_key
from service.lti.problems import LtiError
from service.lti.registrations import Registration
from service.lti.scores.score_problems import LaterError, RefusedError
from service.regex import regex
from service.translations import say

_ASSERTION: Final = "urn:ietf:params:oauth:client-assertion-type:jwt-bearer"
# How long our assertion is valid. It begins a little in the past: clocks differ.
_VALID: Final = timedelta(minutes=5)
_PAST: Final = timedelta(seconds=5)
# A token is used until this long before its end, and at most this long (seconds).
_BEFORE_END: Final = 60.0
_LONGEST: Final = 86_400.0
_USUAL: Final = 3600.0
_TOKEN: Final = regex(r"[\x21-\x7e]{1,16000}")


class AccessTokens:
    """The access tokens of this process, by registration and scopes."""

    def __init__(self, now: Callable[[], datetime], key: Callable[[], SigningKey]) -> None:
        # ``now`` returns the time, and ``key`` our signing key.
        self._now, self._key = now, key
        self._known: dict[tuple[str, str], tuple[str, datetime]] = {}

    def token(self, registration: Registration, scopes: str) -> str:
        """Return an access token for these scopes. Raises RefusedError, LaterError."""
        place, now = (registration.id, scopes), self._now()
        known = self._known.get(place)
        if known is not None and now < known[1]:
            return known[0]
        token, seconds = fetched_token(registration, scopes, self._key(), now)
        kept = max(min(seconds, _LONGEST) - _BEFORE_END, seconds / 2)
        self._known[place] = token, now + timedelta(seconds=min(kept, _LONGEST))
        return token

    def forget(self, registration: Registration, scopes: str) -> None:
        """Forget a token that the platform does not accept any more."""
        self._known.pop((registration.id, scopes), None)


def fetched_token(
    registration: Registration, scopes: str, key: SigningKey, now: datetime
) -> tuple[str, float]:
    """Fetch an access token; return it and its lifetime in seconds.

    Raises RefusedError, LaterError.
    """
    if registration.token_url is None:
        raise RefusedError("no-token-address")
    claims = {
        "iss": registration.client_id,
        "sub": registration.client_id,
        "aud": registration.audience or registration.token_url,
        "iat": int((now - _PAST).timestamp()),
        "exp": int((now + _VALID).timestamp()),
        "jti": secrets.token_urlsafe(16),
    }
    fields = {
        "grant_type": "client_credentials",
        "client_assertion_type": _ASSERTION,
        "client_assertion": jwt.encode(claims, key.private_key, "RS256", {"kid": key.id}),
        "scope": scopes,
    }
    local = registration.is_development
    try:
        with answer(registration.token_url, "POST", local=local, data=fields) as response:
            if response.status_code != HTTPStatus.OK:
                reason = say("the status is {status}", status=response.status_code)
                raise LaterError("token-refused", seconds_to_wait(response.headers), reason=reason)
            found = json.loads(content(response))
    except FetchError as error:
        raise LaterError("token-refused", reason=error) from error
    except (ValueError, RecursionError) as error:
        raise LaterError("token-refused", reason=say("the answer is not JSON")) from error
    token = found.get("access_token") if isinstance(found, dict) else None
    if not isinstance(token, str) or not _TOKEN.fullmatch(token):
        raise LaterError("token-refused", reason=say("the answer has no token"))
    seconds = found.get("expires_in", _USUAL)
    is_number = isinstance(seconds, int | float) and not isinstance(seconds, bool)
    return token, float(seconds) if is_number and 0 < seconds < 1e9 else _USUAL


def available_key(engine: Engine, secret: Secret, now: datetime) -> SigningKey:
    """Return our signing key; make one if there is none. Raises LaterError."""

    def found() -> SigningKey:
        with engine.connect() as connection:
            return signing_key(connection, secret, now)

    try:
        return found()
    except LtiError:
        in_transaction(engine, lambda it: ensure_key(it, secret, now))
    try:
        return found()
    except LtiError as error:
        raise LaterError("no-secret") from error


def seconds_to_wait(headers: Mapping[str, str]) -> float | None:
    """Return the seconds of the header ``Retry-After``, or None."""
    text = headers.get("retry-after", "")
    return float(text) if re.fullmatch(r"\d{1,9}", text, re.ASCII) else None
