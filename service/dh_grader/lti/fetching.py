"""Fetch from a platform safely, because the address comes from outside; keys of both sides.

What is asked, and what an answer means, is in the other files.
"""

import asyncio
import json
import secrets
import socket
import ssl
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from functools import cache, lru_cache
from http import HTTPStatus
from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network, ip_address
from time import monotonic
from typing import Any, Final, NamedTuple
from urllib.parse import urljoin

import httpcore
import httpx
from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPrivateKey, RSAPublicKey
from cryptography.hazmat.primitives.serialization import (
    BestAvailableEncryption,
    Encoding,
    PrivateFormat,
    load_pem_private_key,
)
from jwt import PyJWK
from jwt.algorithms import RSAAlgorithm
from jwt.exceptions import InvalidKeyError, PyJWKError
from sqlalchemy import Connection, Row, delete, insert, select

from dh_grader import VERSION
from dh_grader.access import Secret
from dh_grader.lti import PlatformThreads
from dh_grader.lti.registrations import LOCAL_HOSTS, LtiError, Registration, origin_of, unusable
from dh_grader.store.tables import own_keys
from dh_grader.translations import say

# --- Fetch from an address, within limits
#
# Only HTTPS and public addresses are allowed, and no redirect to another host. The name of the host
# is resolved once: the connection goes to the checked addresses. Every exchange ends after five
# seconds in all, however slowly the platform sends.


# Moodle refuses requests without one.
USER_AGENT: Final = f"dh-grader/{VERSION}"
LARGEST: Final = 64 * 1024
# How long one exchange may take, from the name of the host to the last byte (seconds).
TIMEOUT: Final = 5.0
_MOST_REDIRECTS: Final = 3
# The most bytes before the content, with those of interim responses (1xx).
_LARGEST_HEAD: Final = 128 * 1024
# The most addresses of a host that are tried, and the most names that are looked up at once.
_MOST_ADDRESSES: Final = 4
_MOST_LOOKUPS: Final = 32

# The blocks that are not globally reachable by the registries of special-purpose addresses of IANA
# (as of 2025), those that it has taken back, and multicast. Python's own list differs between its
# versions.
_SPECIAL: Final = tuple(
    map(
        IPv4Network,
        (
            "0.0.0.0/8", "10.0.0.0/8", "100.64.0.0/10", "127.0.0.0/8", "169.254.0.0/16",
            "172.16.0.0/12", "192.0.0.0/24", "192.0.2.0/24", "192.88.99.0/24", "192.168.0.0/16",
            "198.18.0.0/15", "198.51.100.0/24", "203.0.113.0/24", "224.0.0.0/4", "240.0.0.0/4",
        ),
    )
)  # fmt: skip
# IANA has allocated addresses of hosts from this block only. Within it: protocol assignments with
# Teredo, documentation (two), and 6to4. Teredo and 6to4 contain an IPv4 address, which may be
# private (RFC 4380, RFC 3056).
_ALLOCATED: Final = IPv6Network("2000::/3")
_SPECIAL_6: Final = tuple(
    map(IPv6Network, ("2001::/23", "2001:db8::/32", "2002::/16", "3fff::/20"))
)
# In networks without IPv4, every host of IPv4 has an address of this block (NAT64, RFC 6052).
_TRANSLATED: Final = IPv6Network("64:ff9b::/96")


class FetchError(Exception):
    """A URL was not fetched. The message says why, without the content of the response."""


class TooLargeError(FetchError):
    """The response is larger than allowed."""


def fetch_json(url: str, *, local: bool = False) -> Any:
    """Return the JSON document at an address. Raises FetchError.

    ``local`` also allows plain HTTP on this machine.
    """
    until = monotonic() + TIMEOUT
    first = url
    for _ in range(_MOST_REDIRECTS + 1):
        with answer(url, local=local, until=until) as response:
            if not response.is_redirect:
                if response.status_code != HTTPStatus.OK:
                    raise FetchError(say("the status is {status}", status=response.status_code))
                try:
                    return json.loads(content(response))
                except (ValueError, RecursionError) as error:
                    raise FetchError(say("the answer is not JSON")) from error
            url = urljoin(url, response.headers.get("location", ""))
        if unusable(url, local=local) or origin_of(url) != origin_of(first):
            raise FetchError(say("the answer is a redirect to another host"))
    raise FetchError(say("the answers are too many redirects"))


@contextmanager
def answer(
    url: str,
    method: str = "GET",
    *,
    local: bool = False,
    until: float | None = None,
    **more: Any,
) -> Iterator[httpx.Response]:
    """Send a request, and yield the response. Raises FetchError.

    The exchange ends ``TIMEOUT`` seconds from now, or at ``until`` (a time of ``monotonic``) if
    that is earlier. ``more`` are further arguments of ``httpx.Client.stream``. Read the response's
    body with ``content``, which limits its size.
    """
    if reason := unusable(url, local=local):
        raise FetchError(say("the address {reason}", reason=reason))
    latest = monotonic() + TIMEOUT
    until = latest if until is None else min(until, latest)
    addresses = _addresses(httpx.URL(url).host, until, local=local)
    headers = {
        **more.pop("headers", {}),
        "User-Agent": USER_AGENT,
        "Accept-Encoding": "identity",
    }
    try:
        with (
            httpx.Client(transport=_Transport(addresses, until), trust_env=False) as client,
            client.stream(method, url, headers=headers, **more) as response,
        ):
            yield response
    except (httpx.HTTPError, httpcore.NetworkError, httpcore.ProtocolError) as error:
        raise FetchError(
            say("the platform does not answer ({error})", error=type(error).__name__)
        ) from error


def content(response: httpx.Response, largest: int = LARGEST) -> bytes:
    """Read and return the body of a response, up to a size. Raises FetchError."""
    if response.headers.get("content-encoding", "identity") != "identity":
        raise FetchError(say("the answer is compressed"))
    found = bytearray()
    for piece in response.iter_raw():
        found += piece
        if len(found) > largest:
            raise _too_large(largest)
    return bytes(found)


def is_public(address: IPv4Address | IPv6Address) -> bool:
    """True if an address belongs to the public internet."""
    if isinstance(address, IPv4Address):
        return not any(address in each for each in _SPECIAL)
    if address in _TRANSLATED:
        return is_public(IPv4Address(int(address) & 0xFFFFFFFF))
    return address in _ALLOCATED and not any(address in each for each in _SPECIAL_6)


def _late() -> FetchError:
    return FetchError(say("the answer takes too long"))


def _too_large(largest: int) -> TooLargeError:
    return TooLargeError(say("the answer is larger than {most} KiB", most=largest // 1024))


@cache
def _tls() -> ssl.SSLContext:
    # Memoized: making the settings takes longer than a request.
    return httpx.create_ssl_context(trust_env=False)


class _Transport(httpx.BaseTransport):
    """Sends one request to the first of several addresses that answers, and ends in time."""

    # The timeouts of httpx count for each piece of an answer: a platform that sends a byte a second
    # would never end.

    def __init__(self, addresses: Sequence[IPv4Address | IPv6Address], until: float) -> None:
        self._network = _Network(addresses, until)
        self._pool = httpcore.ConnectionPool(_tls(), network_backend=self._network)

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        """Send a request, and return the response with a body that is still to be read."""
        url = request.url
        asked = httpcore.Request(
            request.method,
            httpcore.URL(
                scheme=url.raw_scheme, host=url.raw_host, port=url.port, target=url.raw_path
            ),
            headers=request.headers.raw,
            content=request.stream,
        )
        found = self._pool.handle_request(asked)
        self._network.begin_content()
        return httpx.Response(found.status, headers=found.headers, stream=_Body(found))

    def close(self) -> None:
        """Close the connection."""
        self._pool.close()


class _Body(httpx.SyncByteStream):
    def __init__(self, response: httpcore.Response) -> None:
        self._response = response

    def __iter__(self) -> Iterator[bytes]:
        return self._response.iter_stream()

    def close(self) -> None:
        self._response.close()


class _Network(httpcore.NetworkBackend):
    """Connects to checked addresses, whatever the name of the host."""

    def __init__(self, addresses: Sequence[IPv4Address | IPv6Address], until: float) -> None:
        self._addresses, self._until = addresses, until
        self._connected: _Connection | None = None

    def connect_tcp(
        self,
        host: str,  # noqa: ARG002 - it was resolved and checked before
        port: int,
        timeout: float | None = None,  # noqa: ARG002 - the end is the same for all steps
        local_address: str | None = None,  # noqa: ARG002
        socket_options: Iterable[Any] | None = None,  # noqa: ARG002
    ) -> httpcore.NetworkStream:
        """Return a connection to the first address that accepts one. Raises FetchError."""
        failure: OSError = TimeoutError()
        for tried, address in enumerate(self._addresses):
            # An address that does not answer leaves time for the others.
            share = (self._until - monotonic()) / (len(self._addresses) - tried)
            if share <= 0:
                break
            try:
                connected = socket.create_connection((str(address), port), share)
            except OSError as error:
                failure = error
                continue
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._connected = _Connection(connected, self._until, _LARGEST_HEAD)
            return self._connected
        if isinstance(failure, TimeoutError):
            raise _late() from failure
        raise httpcore.ConnectError(str(failure)) from failure

    def begin_content(self) -> None:
        """End the limit of the response's head."""
        if self._connected is not None:
            self._connected.end_limit()


class _Connection(httpcore.NetworkStream):
    """A connection whose steps, together, end in time.

    TLS, which is begun on it, is a connection of its own with the same limits.
    """

    def __init__(self, connected: socket.socket, until: float, most: float) -> None:
        self._socket, self._until, self._most = connected, until, most
        self._secure: _Connection | None = None

    def end_limit(self) -> None:
        """End the limit of the bytes that are read."""
        self._most = float("inf")
        if self._secure is not None:
            self._secure.end_limit()

    def read(self, max_bytes: int, timeout: float | None = None) -> bytes:  # noqa: ARG002
        """Return the next bytes, or b"" at the end. Raises FetchError."""
        with self._step(httpcore.ReadError):
            data = self._socket.recv(max_bytes)
        self._most -= len(data)
        if self._most < 0:
            raise _too_large(_LARGEST_HEAD)
        return data

    def write(self, buffer: bytes, timeout: float | None = None) -> None:  # noqa: ARG002
        """Send all bytes. Raises FetchError."""
        while buffer:
            with self._step(httpcore.WriteError):
                sent = self._socket.send(buffer)
            buffer = buffer[sent:]

    def start_tls(
        self,
        ssl_context: ssl.SSLContext,
        server_hostname: str | None = None,
        timeout: float | None = None,  # noqa: ARG002
    ) -> httpcore.NetworkStream:
        """Return the same connection, encrypted. Raises FetchError."""
        try:
            with self._step(httpcore.ConnectError):
                wrapped = ssl_context.wrap_socket(self._socket, server_hostname=server_hostname)
        except BaseException:
            self.close()
            raise
        self._secure = _Connection(wrapped, self._until, self._most)
        return self._secure

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()

    def get_extra_info(self, info: str) -> Any:  # noqa: ARG002
        """Return None: httpcore asks for the protocol of TLS, which is always HTTP/1.1."""
        return None

    @contextmanager
    def _step(self, failure: type[httpcore.NetworkError]) -> Iterator[None]:
        left = self._until - monotonic()
        if left <= 0:
            raise _late()
        try:
            self._socket.settimeout(left)
            yield
        except TimeoutError as error:
            raise _late() from error
        except OSError as error:
            raise failure(str(error)) from error


def _addresses(host: str, until: float, *, local: bool) -> Sequence[IPv4Address | IPv6Address]:
    try:
        found = [ip_address(each) for each in dict.fromkeys(_looked_up(host, until))]
    except (OSError, UnicodeError, ValueError) as error:
        raise FetchError(say("the name of the host is not known")) from error
    is_local = local and host in LOCAL_HOSTS
    if not found or not all(each.is_loopback if is_local else is_public(each) for each in found):
        raise FetchError(say("the host has a private address"))
    return found[:_MOST_ADDRESSES]


# The names that are looked up now. Requests for the same name share its result.
_lookups: Final[dict[str, Future[list[str]]]] = {}
_lookups_lock: Final = threading.Lock()


def _looked_up(host: str, until: float) -> list[str]:
    # Nothing ends the system's resolver, which may take a minute. So it runs in a thread of its
    # own, which may outlive the exchange.
    with _lookups_lock:
        found = _lookups.get(host)
        if found is None:
            if len(_lookups) >= _MOST_LOOKUPS:
                raise _late()
            found = _lookups[host] = Future()
            threading.Thread(
                target=_look_up, args=(host, found), name="lti-name", daemon=True
            ).start()
    try:
        return found.result(max(0.0, until - monotonic()))
    except TimeoutError as error:
        raise _late() from error


def _look_up(host: str, found: "Future[list[str]]") -> None:
    try:
        listed = socket.getaddrinfo(host, None, type=socket.SOCK_STREAM)
        result, failure = [str(each[4][0]) for each in listed], None
    except Exception as error:  # noqa: BLE001 - whoever asked gets it
        result, failure = [], error
    with _lookups_lock:
        del _lookups[host]
    if failure is None:
        found.set_result(result)
    else:
        found.set_exception(failure)


# --- The public keys of platforms, memoized in this process


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


# --- The keys with which this service signs messages to platforms, and their rotation


# How long a new key is published before it signs, because platforms memoize our keys. The first key
# signs at once.
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
    """Return the newest key that may sign; ``ensure_key`` makes the first. Raises LtiError."""
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
    """Make the first key, which may sign at once, if there is none."""
    if connection.scalar(select(own_keys.c.id).limit(1)) is None:
        _add(connection, secret, now, now)


def rotate(connection: Connection, secret: Secret, now: datetime) -> datetime:
    """Add a key and return when it begins to sign; keep only one older key.

    If the newest key does not sign yet, nothing changes.
    """
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
