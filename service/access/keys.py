"""Keys as they are known to the service, which never keeps their text."""

import hmac
from dataclasses import dataclass
from datetime import datetime
from typing import Final, Protocol

from service.access.caller import Caller, Scope

# So many characters a secret has at least; 64 hexadecimal digits are usual.
SHORTEST_SECRET: Final = 32


class KeysUnreachableError(Exception):
    """The database of the keys does not answer."""


class KeysBusyError(Exception):
    """Too many unknown keys are being looked up; a known one never waits for them."""


class CredentialError(Exception):
    """A key or token that is not valid; the text says why."""


@dataclass(frozen=True, slots=True)
class Key:
    """A key. ``exercises`` are those it is bound to, None for all; moments are in UTC."""

    id: str
    name: str
    scopes: frozenset[Scope]
    exercises: frozenset[str] | None
    created_at: datetime
    expires_at: datetime
    revoked_at: datetime | None = None
    last_used_at: datetime | None = None

    def caller(self, now: datetime) -> Caller:
        """Who holds it. Raises CredentialError where it is not valid any more."""
        if self.revoked_at is not None:
            raise CredentialError("The key was revoked.")
        if self.expires_at <= now:
            raise CredentialError("The key has expired.")
        return Caller(self.scopes | {Scope.GRADE}, self.exercises, key_id=self.id)


WRONG_SECRET: Final = (
    "This is not the secret with which the keys in the database were made. Set DH_GRADER_SECRET, "
    "or DH_GRADER_SECRET_FILE, to that one. If it is lost, revoke every key (dh-grader keys list "
    "shows them), and create new ones."
)


class Keys(Protocol):
    """The keys of an installation."""

    async def are_needed(self) -> bool:
        """Whether there is any key; revoked and expired ones count."""

    async def caller(self, credential: str) -> Caller:
        """The holder of a key or token.

        Raises CredentialError, KeysUnreachableError, KeysBusyError.
        """

    def token(self, caller: Caller, expires_at: datetime) -> str:
        """A token with the rights of ``caller``."""

    def close(self) -> None:
        """Write what waits, and end."""


class Secret:
    """The secret of an installation, from which those of its keys and tokens are derived."""

    def __init__(self, text: str) -> None:
        self._text = text.encode()

    def key_digest(self, key: str) -> str:
        """What is kept of a key: without the secret nobody finds a key that has it."""
        return hmac.digest(self._derived("keys"), key.encode(), "sha256").hex()

    @property
    def check(self) -> str:
        """By what another secret is known; it tells nothing of the keys."""
        return self._derived("check").hex()

    @property
    def token_secret(self) -> bytes:
        """What tokens are signed with."""
        return self._derived("tokens")

    def _derived(self, purpose: str) -> bytes:
        return hmac.digest(self._text, f"dh-grader {purpose}".encode(), "sha256")
