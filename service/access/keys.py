"""API keys, and the secret of an installation."""

import hmac
from dataclasses import dataclass
from datetime import datetime
from typing import Final, Protocol

from service.access.caller import Caller, Scope
from service.access.key_text import key_text_of
from service.translations import say

# The least number of characters of a secret; 64 hexadecimal digits are usual.
SHORTEST_SECRET: Final = 32


class KeysUnreachableError(Exception):
    """The database of the keys does not respond."""


class KeysBusyError(Exception):
    """Too many unknown keys are being looked up."""

    # Known keys do not wait for them.


class CredentialError(Exception):
    """The key or token is not valid; the message says why."""


@dataclass(frozen=True, slots=True)
class Key:
    """An API key.

    ``exercises`` are the exercises that the key may use; None means all exercises. A key with a
    ``course`` is for this course only. A key with a ``learner`` is a personal link.
    """

    id: str
    name: str
    scopes: frozenset[Scope]
    exercises: frozenset[str] | None
    created_at: datetime
    expires_at: datetime
    revoked_at: datetime | None = None
    last_used_at: datetime | None = None
    course: str | None = None
    learner: str | None = None

    def caller(self, now: datetime) -> Caller:
        """Return the caller with this key. Raises CredentialError if it is not valid now."""
        if self.revoked_at is not None:
            raise CredentialError(say("The key was revoked."))
        if self.expires_at <= now:
            raise CredentialError(say("The key has expired."))
        scopes = self.scopes | {Scope.GRADE}
        return Caller(scopes, self.exercises, self.learner, self.id, self.course)


WRONG_SECRET: Final = say(
    "This is not the secret with which the keys in the database were made. Set DH_GRADER_SECRET, "
    "or DH_GRADER_SECRET_FILE, to that one. If it is lost, revoke every key (dh-grader keys list "
    "shows them), and create new ones."
)


class Keys(Protocol):
    """The API keys of an installation."""

    async def are_needed(self) -> bool:
        """True if any key exists."""
        # Revoked and expired keys count, too.

    async def caller(self, credential: str) -> Caller:
        """Return the caller with this key or token.

        Raises CredentialError, KeysUnreachableError, KeysBusyError.
        """

    def expect_keys(self) -> None:
        """Note that a key was created just now."""

    def token(self, caller: Caller, expires_at: datetime) -> str:
        """Return a token for the caller's learner, valid until ``expires_at``."""

    async def session_caller(self, session: str) -> Caller:
        """Return the caller with this session token.

        Raises CredentialError, KeysUnreachableError, KeysBusyError.
        """

    def session(self, caller: Caller, expires_at: datetime) -> str:
        """Return a session token for ``caller``, who holds a key."""

    @property
    def secret(self) -> "Secret | None":
        """The secret of the installation, or None if it is not known."""

    def close(self) -> None:
        """Save when keys were last used, and stop all threads."""


class Secret:
    """The secret of an installation, from which all its other secrets are derived."""

    def __init__(self, text: str) -> None:
        self._text = text.encode()

    def key_digest(self, key: str) -> str:
        """Return the keyed hash of an API key, which is stored instead of its text."""
        return hmac.digest(self._derived("keys"), key.encode(), "sha256").hex()

    def link_key(self, key_id: str) -> str:
        """Return the API key for a personal link; equal ids give equal keys."""
        return key_text_of(hmac.digest(self._derived("links"), key_id.encode(), "sha512"))

    @property
    def check(self) -> str:
        """A digest of the secret; equal secrets have equal digests."""
        return self._derived("check").hex()

    @property
    def token_secret(self) -> bytes:
        """The key that signs tokens."""
        return self._derived("tokens")

    @property
    def session_secret(self) -> bytes:
        """The key that signs the sessions of tutors."""
        return self._derived("sessions")

    @property
    def lti_secret(self) -> bytes:
        """The key that encrypts our private keys for LTI, and makes pseudonyms."""
        return self._derived("lti")

    def _derived(self, purpose: str) -> bytes:
        return hmac.digest(self._text, f"dh-grader {purpose}".encode(), "sha256")
