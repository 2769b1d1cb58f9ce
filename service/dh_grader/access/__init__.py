"""Who may do what: the rights of callers, API keys, and what is open without a key.

Nothing here reads a database: ``key_ring`` looks keys up, ``rates`` counts requests.
"""

import hmac
import ipaddress
import secrets
import string
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from hashlib import sha256
from typing import Final, Protocol
from zlib import crc32

from dh_grader.translations import say

# --- The caller of a request and its rights


class Scope(StrEnum):
    """A right of a key. Every key has the right to grade."""

    GRADE = "grade"
    RECORD = "record"
    TUTOR = "tutor"


@dataclass(frozen=True, slots=True)
class Caller:
    """The caller of a request: the holder of a key or token, or an anonymous client.

    ``exercises``, ``learner`` and ``course`` restrict the caller; None means no restriction.
    """

    scopes: frozenset[Scope]
    exercises: frozenset[str] | None = None
    learner: str | None = None
    key_id: str = ""
    course: str | None = None

    def reaches(self, exercise: str) -> bool:
        """True if the caller may use this exercise; ``exercise`` may be the id of a variant."""
        return self.exercises is None or exercise.partition("~")[0] in self.exercises

    @property
    def reaches_all(self) -> bool:
        """True if the caller is restricted neither to exercises nor to a course."""
        return self.exercises is None and self.course is None

    @property
    def owner(self) -> str:
        """The id under which requests and attempts of the caller are recorded.

        The id of an anonymous client is "".
        """
        # At most 32 characters: the id of a key, or a hash for each learner with a token. A
        # course's learner stays the same owner when the personal link is renewed.
        if self.learner is None:
            return self.key_id
        by = self.key_id if self.course is None else f"course {self.course}"
        return sha256(f"{by} {self.learner}".encode()).hexdigest()[:32]


NOBODY: Final = Caller(frozenset())


# --- What needs no API key


UNTIL_KEYS: Final = "until-keys"
NOTHING: Final = "none"


@dataclass(frozen=True, slots=True)
class OpenAccess:
    """The scopes (rights of a key) that never need a key.

    With ``until_keys``, nothing needs a key as long as no key exists. This applies only to requests
    to the loopback address, unless ``anywhere`` is set.
    """

    scopes: frozenset[Scope] = frozenset()
    until_keys: bool = True
    anywhere: bool = False


# For a service that listens on localhost only, and for one that is configured to be open.
OPEN_HERE: Final = OpenAccess()
OPEN_ANYWHERE: Final = OpenAccess(anywhere=True)


def open_access(text: str | None) -> OpenAccess:
    """Parse the setting ``open``; None means the default. Raises ValueError."""
    match text:
        case None:
            return OPEN_HERE
        case "until-keys":
            return OPEN_ANYWHERE
        case "none":
            return OpenAccess(until_keys=False, anywhere=True)
    scopes = {word.strip() for word in text.split(",")}
    if not scopes <= {Scope.GRADE, Scope.RECORD}:
        raise ValueError(
            say(
                "write {until_keys}, {nothing}, or what needs no key: {grade}, or {grade},{record}",
                until_keys=UNTIL_KEYS,
                nothing=NOTHING,
                grade=Scope.GRADE.value,
                record=Scope.RECORD.value,
            )
        )
    return OpenAccess(frozenset(map(Scope, scopes)) | {Scope.GRADE}, False, anywhere=True)


# --- API keys, and the secret of an installation


# The least number of characters of a secret; 64 hexadecimal digits are usual.
SHORTEST_SECRET: Final = 32


class KeysUnreachableError(Exception):
    """The database of the keys does not respond."""


class KeysBusyError(Exception):
    """Too many unknown keys are being looked up. Known keys do not wait for them."""


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
        """True if any key exists, also a revoked or expired one."""

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


# --- The text of an API key
#
# The prefix lets scanners find keys that were published by mistake. The checksum lets the service
# refuse a misspelt key without asking the database.


PREFIX: Final = "dhg_"
_ALPHABET: Final = string.digits + string.ascii_letters
# 190 random bits.
_RANDOM: Final = 32
_CHECKSUM: Final = 6


def new_key_text() -> str:
    """Return the text of a new random key."""
    drawn = "".join(secrets.choice(_ALPHABET) for _ in range(_RANDOM))
    return f"{PREFIX}{drawn}{_checksum(drawn)}"


def key_text_of(seed: bytes) -> str:
    """Return the text of a key made of 64 bytes; equal bytes give equal texts."""
    rest = int.from_bytes(seed)
    digits = []
    for _ in range(_RANDOM):
        rest, digit = divmod(rest, len(_ALPHABET))
        digits.append(_ALPHABET[digit])
    drawn = "".join(digits)
    return f"{PREFIX}{drawn}{_checksum(drawn)}"


def is_spelt_right(text: str) -> bool:
    """True if a text has the form of a key and a correct checksum."""
    drawn, checksum = text[len(PREFIX) : -_CHECKSUM], text[-_CHECKSUM:]
    return (
        text.startswith(PREFIX)
        and len(drawn) == _RANDOM
        and set(text[len(PREFIX) :]) <= set(_ALPHABET)
        and checksum == _checksum(drawn)
    )


def _checksum(drawn: str) -> str:
    rest = crc32(drawn.encode())
    digits = []
    for _ in range(_CHECKSUM):
        rest, digit = divmod(rest, len(_ALPHABET))
        digits.append(_ALPHABET[digit])
    return "".join(digits)


# --- Find the client of a request by its address, for scheduling and for limits


def client_key(address: str) -> str:
    """Return the client of an address: the IPv4 address, or the /64 network of the IPv6 address."""
    # One client may own a whole /64 network. An IPv4 address in IPv6 notation, such as
    # ``::ffff:10.0.0.7``, counts as the IPv4 address.
    if ":" not in address:
        return address
    try:
        found = ipaddress.IPv6Address(address.partition("%")[0])
    except ValueError:
        return address
    if found.ipv4_mapped is not None:
        return str(found.ipv4_mapped)
    return str(ipaddress.IPv6Network((found, 64), strict=False))
