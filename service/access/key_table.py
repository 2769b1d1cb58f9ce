"""Database functions for API keys."""

import json
import secrets
from collections.abc import Collection, Iterable
from dataclasses import asdict, replace
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, and_, delete, exists, or_, select

from service.access.caller import Scope
from service.access.keys import Key, Secret
from service.attempts.recording import insert_or_ignore
from service.attempts.storage.tables import key_secrets, keys


def any_key(connection: Connection) -> bool:
    """True if a key has ever been created."""
    return bool(connection.scalar(select(exists(select(keys.c.id)))))


def fits(connection: Connection, secret: Secret) -> bool:
    """True if this secret belongs to the keys in the database."""
    # The result is also True if the database has recorded no secret.
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
    """Insert a new key; ``digest`` is the keyed hash of its text."""
    # The text itself is not stored.
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


def keys_at(
    connection: Connection, places: Collection[tuple[str, str]]
) -> dict[tuple[str, str], Key]:
    """Return the keys with these ids or digests; leave out unknown ones.

    ``places`` has pairs: a column (``id`` or ``digest``) and its value.
    """
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
