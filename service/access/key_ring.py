"""The API keys of the database, memoized for a few seconds."""

import asyncio
from collections import OrderedDict
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from time import monotonic
from typing import Final, TypeVar

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from service.access.caller import Caller, Scope
from service.access.key_lookups import KeyLookups, KeyPlace
from service.access.key_table import any_key, fits, keys_at, note_use
from service.access.key_text import PREFIX, is_spelt_right
from service.access.keys import CredentialError, Key, KeysUnreachableError, Secret
from service.attempts.storage.database import in_transaction
from service.translations import say

R = TypeVar("R")

# How long a known key is memoized (seconds). A revoked key works at most this long.
MEMOIZED_SECONDS: Final = 5.0
# The most memoized keys.
_MOST: Final = 2000
# The most memoized unknown keys, and for how long (seconds): a key may be created meanwhile.
_MOST_UNKNOWN: Final = 4000
_UNKNOWN_SECONDS: Final = 2.0
# The pause between look-ups of unknown keys (seconds): a client may invent any number of them.
_PAUSE: Final = 0.01
# The interval in which the last use of a key is written.
_USE_INTERVAL: Final = timedelta(minutes=1)
# How long a known key is not looked up again after the database has failed (seconds).
_DOWN_SECONDS: Final = 15.0


@dataclass(frozen=True, slots=True)
class _Found:
    key: Key
    until: float


class KeyRing:
    """The API keys of one database. Known keys work while the database is down."""

    def __init__(
        self, engine: Engine, secret: Secret | None, seconds: float = MEMOIZED_SECONDS
    ) -> None:
        # Raises KeysUnreachableError.
        self._engine = engine
        self.secret = secret
        self._seconds = seconds
        self._found: OrderedDict[KeyPlace, _Found] = OrderedDict()
        self._unknown: OrderedDict[KeyPlace, float] = OrderedDict()
        # Separate threads: known keys and notes of their use do not wait for unknown keys.
        self._known_lookups = KeyLookups(self._find)
        self._new_lookups = KeyLookups(self._find, _PAUSE)
        self._thread = ThreadPoolExecutor(1, "keys")
        self._noted_uses: dict[str, datetime] = {}
        self.has_keys = self._read(any_key)
        self.has_their_secret = secret is None or self._read(lambda each: fits(each, secret))
        self._next_check = monotonic() + seconds
        # Child processes that start later must not inherit a connection.
        engine.dispose()

    async def are_needed(self) -> bool:
        """True if a key has ever been created."""
        if not self.has_keys and monotonic() >= self._next_check:
            self._next_check = monotonic() + self._seconds
            with suppress(KeysUnreachableError):
                self.has_keys = await self._in_thread(lambda: self._read(any_key))
        return self.has_keys

    def expect_keys(self) -> None:
        """Note that a key was created just now, so that keys are needed."""
        self.has_keys = True

    async def caller(self, credential: str) -> Caller:
        """Return the caller with this key or token.

        Raises CredentialError, KeysUnreachableError, KeysBusyError.
        """
        if self.secret is None:
            raise CredentialError(
                say("The service cannot check keys: DH_GRADER_SECRET is not set.")
            )
        if not credential.startswith(PREFIX):
            # Import here: most installations have no tokens.
            from service.access.tokens import verified

            token = verified(credential, self.secret.token_secret)
            return token.caller(await self._holder("id", token.key_id))
        if not is_spelt_right(credential):
            raise CredentialError(say("The key is misspelt: its checksum is wrong."))
        return await self._holder("digest", self.secret.key_digest(credential))

    def token(self, caller: Caller, expires_at: datetime) -> str:
        """Return a token for the caller's learner, valid until ``expires_at``."""
        from service.access.tokens import LearnerToken, signed

        assert self.secret is not None
        assert caller.learner is not None
        scopes = caller.scopes - {Scope.TUTOR}
        token = LearnerToken(caller.key_id, caller.learner, scopes, caller.exercises)
        return signed(token, expires_at, self.secret.token_secret)

    async def session_caller(self, session: str) -> Caller:
        """Return the caller with this session token.

        Raises CredentialError, KeysUnreachableError, KeysBusyError.
        """
        from service.access.sessions import key_of_session

        if self.secret is None:
            raise CredentialError(
                say("The service cannot check sessions: DH_GRADER_SECRET is not set.")
            )
        return await self._holder("id", key_of_session(session, self.secret.session_secret))

    def session(self, caller: Caller, expires_at: datetime) -> str:
        """Return a session token for ``caller``, who holds a key."""
        from service.access.sessions import signed_session

        assert self.secret is not None
        return signed_session(caller.key_id, expires_at, self.secret.session_secret)

    def close(self) -> None:
        """Stop the threads, and save the times at which keys were last used."""
        self._known_lookups.close()
        self._new_lookups.close()
        self._thread.shutdown()

    async def _holder(self, column: str, value: str) -> Caller:
        key = await self._key((column, value))
        if key is None:
            raise CredentialError(say("This service has no such key."))
        now = datetime.now(UTC)
        caller = key.caller(now)
        self._note_use(key, now)
        return caller

    async def _key(self, at: KeyPlace) -> Key | None:
        now = monotonic()
        found = self._found.get(at)
        if found is not None and now < found.until:
            return found.key
        if found is None and now < self._unknown.get(at, 0.0):
            return None
        try:
            key = await (self._new_lookups if found is None else self._known_lookups).key(at)
        except KeysUnreachableError:
            if found is None:
                raise
            self._found[at] = _Found(found.key, monotonic() + _DOWN_SECONDS)
            return found.key
        self._memoize(at, key)
        return key

    def _memoize(self, place: KeyPlace, key: Key | None) -> None:
        now = monotonic()
        if key is None:
            self._found.pop(place, None)
            self._unknown[place] = now + min(_UNKNOWN_SECONDS, self._seconds)
            self._unknown.move_to_end(place)
            while len(self._unknown) > _MOST_UNKNOWN:
                self._unknown.popitem(last=False)
            return
        self._found[place] = _Found(key, now + self._seconds)
        self._found.move_to_end(place)
        while len(self._found) > _MOST:
            self._found.popitem(last=False)

    def _note_use(self, key: Key, now: datetime) -> None:
        before = self._noted_uses.get(key.id, key.last_used_at)
        if before is None or now - before >= _USE_INTERVAL:
            self._noted_uses[key.id] = now
            self._thread.submit(self._write_use, key.id, now)

    def _write_use(self, key_id: str, now: datetime) -> None:
        # After an error, the next use in a minute or later is written.
        with suppress(SQLAlchemyError):
            in_transaction(self._engine, lambda connection: note_use(connection, key_id, now))

    async def _in_thread(self, work: Callable[[], R]) -> R:
        return await asyncio.get_running_loop().run_in_executor(self._thread, work)

    def _find(self, places: Collection[KeyPlace]) -> Mapping[KeyPlace, Key]:
        return self._read(lambda connection: keys_at(connection, places))

    def _read(self, work: Callable[[Connection], R]) -> R:
        try:
            with self._engine.connect() as connection:
                return work(connection)
        except SQLAlchemyError as error:
            raise KeysUnreachableError from error
