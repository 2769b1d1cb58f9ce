"""The keys with which this service signs messages to platforms, and their rotation."""

# A new key is published for a day before it signs, because platforms memoize our keys.

import json
import secrets
from datetime import datetime, timedelta
from functools import lru_cache
from typing import Any, Final, NamedTuple

from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPrivateKey
from cryptography.hazmat.primitives.serialization import (
    BestAvailableEncryption,
    Encoding,
    PrivateFormat,
    load_pem_private_key,
)
from jwt.algorithms import RSAAlgorithm
from sqlalchemy import Connection, Row, delete, insert, select

from service.access.keys import Secret
from service.attempts.storage.lti_tables import own_keys
from service.lti.problems import LtiError

# How long a new key is published before it signs, unless it is the first one.
PUBLISHED_BEFORE: Final = timedelta(days=1)
_BITS: Final = 2048


class SigningKey(NamedTuple):
    """The key that signs now, and its id (``kid``)."""

    id: str
    private_key: RSAPrivateKey


def published_keys(connection: Connection) -> dict[str, list[dict[str, Any]]]:
    """Return our public keys as a JSON Web Key Set."""
    rows = connection.execute(select(own_keys.c.public_key).order_by(own_keys.c.created_at))
    return {"keys": [json.loads(row.public_key) for row in rows]}


def own_key_list(connection: Connection) -> list[Row[Any]]:
    """Return the id of each key, when it was created, and when it begins to sign."""
    chosen = select(own_keys.c.id, own_keys.c.created_at, own_keys.c.signs_from)
    return list(connection.execute(chosen.order_by(own_keys.c.created_at)))


def signing_key(connection: Connection, secret: Secret, now: datetime) -> SigningKey:
    """Return the newest key that may sign. Raises LtiError."""
    # ``ensure_key`` makes the first key.
    usable = own_keys.c.signs_from <= now
    newest = select(own_keys).where(usable).order_by(own_keys.c.signs_from.desc()).limit(1)
    row = connection.execute(newest).one_or_none()
    if row is None:
        raise LtiError("no-secret")
    try:
        return SigningKey(row.id, _private_key(row.private_key, secret.lti_secret))
    except ValueError as error:
        raise LtiError("no-secret") from error


def ensure_key(connection: Connection, secret: Secret, now: datetime) -> None:
    """Make the first key if there is none."""
    # The first key may sign at once.
    if connection.scalar(select(own_keys.c.id).limit(1)) is None:
        _add(connection, secret, now, now)


def rotate(connection: Connection, secret: Secret, now: datetime) -> datetime:
    """Add a key and return when it begins to sign; keep only one older key."""
    # If the newest key does not sign yet, nothing changes.
    ensure_key(connection, secret, now)
    waiting: datetime | None = connection.scalar(
        select(own_keys.c.signs_from).where(own_keys.c.signs_from > now)
    )
    if waiting is not None:
        return waiting
    newest = select(own_keys.c.id).order_by(own_keys.c.signs_from.desc()).limit(1)
    current = connection.scalar(newest)
    connection.execute(delete(own_keys).where(own_keys.c.id != current))
    signs_from = now + PUBLISHED_BEFORE
    _add(connection, secret, now, signs_from)
    return signs_from


@lru_cache(maxsize=4)
def _private_key(pem: str, password: bytes) -> RSAPrivateKey:
    # Memoized: decrypting takes longer than signing.
    key = load_pem_private_key(pem.encode(), password)
    assert isinstance(key, RSAPrivateKey)
    return key


def _add(connection: Connection, secret: Secret, now: datetime, signs_from: datetime) -> None:
    key_id = secrets.token_hex(8)
    key = rsa.generate_private_key(public_exponent=65537, key_size=_BITS)
    encryption = BestAvailableEncryption(secret.lti_secret)
    pem = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, encryption).decode("ascii")
    public = RSAAlgorithm.to_jwk(key.public_key(), as_dict=True)
    public |= {"kid": key_id, "alg": "RS256", "use": "sig"}
    public.pop("key_ops", None)
    values = {"id": key_id, "private_key": pem, "public_key": json.dumps(public)}
    times = {"created_at": now, "signs_from": signs_from}
    connection.execute(insert(own_keys).values(values | times))
