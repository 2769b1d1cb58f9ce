"""The public keys of platforms, memoized in this process."""

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from time import monotonic
from typing import Any, Final

from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey
from jwt import PyJWK
from jwt.exceptions import InvalidKeyError, PyJWKError

from service.lti.fetching import FetchError, fetch_json
from service.lti.platform_threads import PlatformThreads
from service.lti.problems import LtiError
from service.lti.registrations import Registration

# How long keys are used without a look whether they are still there (seconds), and how long at
# most while the platform does not answer.
_FRESH: Final = 3600.0
_LONGEST: Final = 24 * 3600.0
# The least time between two fetches for one platform (seconds): anybody can invent a key id.
PAUSE: Final = 60.0
_MOST_KEYS: Final = 100
_LEAST_BITS: Final = 2048

Fetch = Callable[..., Any]


@dataclass
class _Known:
    keys: Mapping[str, RSAPublicKey | None] = field(default_factory=dict)
    fetched_at: float = -_LONGEST
    tried_at: float = -PAUSE
    reason: str = ""
    lock: asyncio.Lock = field(default_factory=asyncio.Lock)


class PlatformKeys:
    """The public keys of platforms, fetched from registered addresses only."""

    def __init__(
        self,
        threads: PlatformThreads,
        fetch: Fetch = fetch_json,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        self._threads, self._fetch, self._clock = threads, fetch, clock
        self._known: dict[tuple[str, str], _Known] = {}

    async def key(self, registration: Registration, key_id: str) -> RSAPublicKey:
        """Return the platform's key with this id. Raises LtiError."""
        known = self._known.setdefault((registration.id, registration.jwks_url), _Known())
        # A launch with a known key does not wait for a slow platform.
        if not self._has_fresh(known, key_id):
            async with known.lock:
                may_fetch = self._clock() >= known.tried_at + PAUSE
                if may_fetch and not self._has_fresh(known, key_id):
                    await self._update(known, registration)
        if self._clock() >= known.fetched_at + _LONGEST:
            raise LtiError("keys-unreachable", reason=known.reason)
        if key_id not in known.keys:
            raise LtiError("unknown-key")
        found = known.keys[key_id]
        if found is None:
            raise LtiError("unusable-key")
        return found

    def _has_fresh(self, known: _Known, key_id: str) -> bool:
        return key_id in known.keys and self._clock() < known.fetched_at + _FRESH

    async def _update(self, known: _Known, registration: Registration) -> None:
        known.tried_at = self._clock()
        local = registration.is_development
        try:
            found = await self._threads.run(
                registration.id, lambda: self._fetch(registration.jwks_url, local=local)
            )
            known.keys = usable_keys(found)
        except FetchError as error:
            known.reason = error.args[0]
        else:
            known.fetched_at, known.reason = self._clock(), ""


def usable_keys(found: Any) -> dict[str, RSAPublicKey | None]:
    """Return the keys of a JSON Web Key Set by id; None marks a key that must not be used.

    Raises FetchError.
    """
    listed = found.get("keys") if isinstance(found, dict) else None
    if not isinstance(listed, list):
        raise FetchError("the answer is no set of keys")
    keys: dict[str, RSAPublicKey | None] = {}
    for each in listed[:_MOST_KEYS]:
        if isinstance(each, dict) and isinstance(each.get("kid"), str):
            keys[each["kid"]] = _usable(each)
    return keys


def _usable(key: dict[str, Any]) -> RSAPublicKey | None:
    if key.get("kty") != "RSA" or key.get("use", "sig") != "sig" or "d" in key:
        return None
    if key.get("alg", "RS256") != "RS256":
        return None
    try:
        made = PyJWK.from_dict(key, "RS256").key
    except (PyJWKError, InvalidKeyError, ValueError, TypeError):
        return None
    is_long = isinstance(made, RSAPublicKey) and made.key_size >= _LEAST_BITS
    return made if is_long else None
