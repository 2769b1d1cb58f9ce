"""The API keys in the database, and the tokens and sessions that name a key.

``KeyRing`` checks all three. What a key may do is in ``dh_grader.access``.
"""

import asyncio
import json
import secrets
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Collection, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime, timedelta
from time import monotonic
from typing import Annotated, Any, Final, Literal, NamedTuple, TypeVar

import jwt
from pydantic import BaseModel, ConfigDict, StringConstraints, ValidationError
from sqlalchemy import Connection, Engine, Row, and_, delete, exists, or_, select
from sqlalchemy.exc import SQLAlchemyError

from dh_grader.access import (
    PREFIX,
    Caller,
    CredentialError,
    Key,
    KeysBusyError,
    KeysUnreachableError,
    Scope,
    Secret,
    is_spelt_right,
)
from dh_grader.contract import Learner
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.store.database import in_transaction
from dh_grader.store.tables import key_secrets, keys
from dh_grader.translations import say

# --- The API keys of the database, memoized for a few seconds


R = TypeVar("R")

# A column of the table of keys, ``id`` or ``digest``, and the value to find there.
KeyPlace = tuple[str, str]

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
            token = verified(credential, self.secret.token_secret)
            return token.caller(await self._holder("id", token.key_id))
        if not is_spelt_right(credential):
            raise CredentialError(say("The key is misspelt: its checksum is wrong."))
        return await self._holder("digest", self.secret.key_digest(credential))

    def token(self, caller: Caller, expires_at: datetime) -> str:
        """Return a token for the caller's learner, valid until ``expires_at``."""
        assert self.secret is not None
        assert caller.learner is not None
        scopes = caller.scopes - {Scope.TUTOR}
        token = LearnerToken(caller.key_id, caller.learner, scopes, caller.exercises)
        return signed(token, expires_at, self.secret.token_secret)

    async def session_caller(self, session: str) -> Caller:
        """Return the caller with this session token.

        Raises CredentialError, KeysUnreachableError, KeysBusyError.
        """
        if self.secret is None:
            raise CredentialError(
                say("The service cannot check sessions: DH_GRADER_SECRET is not set.")
            )
        return await self._holder("id", key_of_session(session, self.secret.session_secret))

    def session(self, caller: Caller, expires_at: datetime) -> str:
        """Return a session token for ``caller``, who holds a key."""
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


# --- Look up keys in the database, many in one statement


# The most keys in one statement.
BATCH: Final = 128
# The most waiting look-ups: more than the connections of a process.
MAX_WAITING: Final = 4096
# The time limit of a look-up (seconds). A paused database raises no error.
TIMEOUT: Final = 15.0


class KeyLookups:
    """Looks up keys in one thread, with a pause between two database statements."""

    # A client may send any number of invented keys. They cost little: at most ``1 / pause``
    # statements per second.

    def __init__(
        self, find: Callable[[Collection[KeyPlace]], Mapping[KeyPlace, Key]], pause: float = 0.0
    ) -> None:
        self._find = find
        self._pause = pause
        self._thread = ThreadPoolExecutor(1, "keys-read")
        self._asked: dict[KeyPlace, asyncio.Future[Key | None]] = {}
        self._waiting: deque[KeyPlace] = deque()
        self._working: asyncio.Task[None] | None = None

    async def key(self, place: KeyPlace) -> Key | None:
        """Return the key with this id or digest; None if there is no such key.

        Raises KeysUnreachableError, KeysBusyError.
        """
        asked = self._asked.get(place)
        if asked is None:
            if len(self._waiting) >= MAX_WAITING:
                raise KeysBusyError
            asked = self._asked[place] = asyncio.get_running_loop().create_future()
            # If all callers have gone, ignore the exception instead of logging it.
            asked.add_done_callback(lambda done: done.cancelled() or done.exception())
            self._waiting.append(place)
            if self._working is None or self._working.done():
                self._working = asyncio.create_task(self._process_waiting())
        try:
            # Shield it: others may wait for the same key when this client has gone.
            return await asyncio.wait_for(asyncio.shield(asked), TIMEOUT)
        except TimeoutError as error:
            raise KeysUnreachableError from error

    def close(self) -> None:
        """Stop the thread."""
        self._thread.shutdown()

    async def _process_waiting(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            while self._waiting:
                batch = [self._waiting.popleft() for _ in range(min(BATCH, len(self._waiting)))]
                try:
                    found = await loop.run_in_executor(self._thread, self._find, batch)
                except Exception as error:  # noqa: BLE001 - passed to every waiting caller
                    for place in batch:
                        self._asked.pop(place).set_exception(error)
                else:
                    for place in batch:
                        self._asked.pop(place).set_result(found.get(place))
                await asyncio.sleep(self._pause)
        finally:
            # Something is left only if the event loop ends during a batch.
            for asked in self._asked.values():
                asked.cancel()
            self._asked.clear()
            self._waiting.clear()


# --- Database functions for API keys


def any_key(connection: Connection) -> bool:
    """True if a key has ever been created."""
    return bool(connection.scalar(select(exists(select(keys.c.id)))))


def fits(connection: Connection, secret: Secret) -> bool:
    """True if this secret belongs to the keys in the database, or if it has recorded none."""
    return connection.scalar(select(key_secrets.c.digest)) in (None, secret.check)


def settle(connection: Connection, secret: Secret, now: datetime) -> bool:
    """Record this secret for new keys; return False if valid keys belong to another secret."""
    valid = exists(select(keys.c.id).where(keys.c.revoked_at.is_(None), keys.c.expires_at > now))
    if not connection.scalar(select(valid)):
        connection.execute(delete(key_secrets))
    new = insert_or_ignore(key_secrets)[connection.dialect.name]
    connection.execute(new.values(id=1, digest=secret.check))
    return fits(connection, secret)


def add_key(
    connection: Connection,
    name: str,
    digest: str,
    scopes: Iterable[Scope],
    exercises: Iterable[str] | None,
    created_at: datetime,
    expires_at: datetime,
    course: str | None = None,
) -> Key:
    """Insert a new key; ``digest`` is the keyed hash of its text, which is not stored."""
    bound = None if exercises is None else frozenset(exercises)
    key = Key(secrets.token_hex(4), name, frozenset(scopes), bound, created_at, expires_at)
    insert_key(connection, replace(key, course=course), digest)
    return key


def insert_key(connection: Connection, key: Key, digest: str) -> None:
    """Insert a key with the digest of its text."""
    values = asdict(key) | {
        "digest": digest,
        "scopes": " ".join(sorted(key.scopes)),
        "exercises": None if key.exercises is None else json.dumps(sorted(key.exercises)),
    }
    connection.execute(keys.insert().values(values))


def all_keys(connection: Connection) -> list[Key]:
    """Return all keys except those of personal links, the oldest first."""
    found = select(keys).where(keys.c.learner.is_(None)).order_by(keys.c.created_at)
    return [_key(row) for row in connection.execute(found)]


def link_keys(connection: Connection, course: str) -> list[Key]:
    """Return the keys of a course's personal links, except revoked keys."""
    links = and_(keys.c.course == course, keys.c.learner.is_not(None), keys.c.revoked_at.is_(None))
    return [_key(row) for row in connection.execute(select(keys).where(links))]


def keys_at(connection: Connection, places: Collection[KeyPlace]) -> dict[KeyPlace, Key]:
    """Return the keys with these ids or digests; leave out unknown ones."""
    columns: dict[str, list[str]] = {column: [] for column, _ in places}
    for column, value in places:
        columns[column].append(value)
    wanted = (keys.c[column].in_(values) for column, values in columns.items())
    rows = connection.execute(select(keys).where(or_(*wanted))).all()
    return {(column, getattr(row, column)): _key(row) for row in rows for column in columns}


def revoke_key(connection: Connection, key_id: str, now: datetime) -> bool:
    """Revoke a key; return False if the key is unknown or already revoked."""
    done = connection.execute(
        keys.update().where(keys.c.id == key_id, keys.c.revoked_at.is_(None)).values(revoked_at=now)
    )
    return done.rowcount > 0


def note_use(connection: Connection, key_id: str, now: datetime) -> None:
    """Record the time of a key's last use."""
    earlier = or_(keys.c.last_used_at.is_(None), keys.c.last_used_at < now)
    connection.execute(keys.update().where(keys.c.id == key_id, earlier).values(last_used_at=now))


def _key(row: Row[Any]) -> Key:
    known = {name: getattr(row, name) for name in Key.__dataclass_fields__}
    known["scopes"] = frozenset(map(Scope, row.scopes.split()))
    known["exercises"] = None if row.exercises is None else frozenset(json.loads(row.exercises))
    return Key(**known)


# --- Tokens of learners: JSON Web Tokens, signed with the secret of the installation
#
# A token names a key and is valid at most as long as the key. Tokens are not stored.


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


# --- Sessions of tutors in a browser
#
# A session is a signed text that names a key and is valid at most as long as the key. Sessions are
# not stored.


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
