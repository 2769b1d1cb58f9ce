"""Fetch JSON from a platform safely, because the address comes from outside.

Only HTTPS and public addresses are allowed, and no redirect to another host.
"""

# The name of the host is resolved once: the connection goes to the checked address.

import json
import socket
import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from http import HTTPStatus
from ipaddress import IPv4Address, IPv6Address, IPv6Network, ip_address
from time import monotonic
from typing import Any, Final
from urllib.parse import urljoin

import httpx

from service.lti.registrations import LOCAL_HOSTS, origin_of, unusable
from service.translations import say
from service.version import VERSION

# Moodle refuses requests without one.
USER_AGENT: Final = f"dh-grader/{VERSION}"
LARGEST: Final = 64 * 1024
TIMEOUT: Final = 5.0
_MOST_REDIRECTS: Final = 3
# Addresses that contain one of IPv4, which may be private (RFC 6052, 3056, 4380).
_TRANSLATED: Final = tuple(map(IPv6Network, ("64:ff9b::/96", "2002::/16", "2001::/32")))


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
        with answer(url, local=local) as response:
            if not response.is_redirect:
                if response.status_code != HTTPStatus.OK:
                    raise FetchError(say("the status is {status}", status=response.status_code))
                try:
                    return json.loads(content(response, until))
                except (ValueError, RecursionError) as error:
                    raise FetchError(say("the answer is not JSON")) from error
            url = urljoin(url, response.headers.get("location", ""))
        if unusable(url, local=local) or origin_of(url) != origin_of(first):
            raise FetchError(say("the answer is a redirect to another host"))
    raise FetchError(say("the answers are too many redirects"))


@contextmanager
def answer(
    url: str, method: str = "GET", *, local: bool = False, **more: Any
) -> Iterator[httpx.Response]:
    """Send a request, and yield the response. Raises FetchError.

    ``more`` are further arguments of ``httpx.Client.stream``.
    """
    # Read the response's body with ``content``, which limits its size.
    if reason := unusable(url, local=local):
        raise FetchError(say("the address {reason}", reason=reason))
    parts = httpx.URL(url)
    # Connect to the checked address: another resolution could give another one.
    pinned = parts.copy_with(host=str(_address(parts.host, local=local)))
    headers = {
        **more.pop("headers", {}),
        "Host": parts.netloc.decode("ascii"),
        "User-Agent": USER_AGENT,
        "Accept-Encoding": "identity",
    }
    named = {"sni_hostname": parts.host}
    try:
        with (
            httpx.Client(verify=_tls(), trust_env=False, timeout=TIMEOUT) as client,
            client.stream(method, pinned, headers=headers, extensions=named, **more) as response,
        ):
            yield response
    except httpx.HTTPError as error:
        raise FetchError(
            say("the platform does not answer ({error})", error=type(error).__name__)
        ) from error


def content(response: httpx.Response, until: float, largest: int = LARGEST) -> bytes:
    """Read and return the body of a response, up to a size and a time. Raises FetchError."""
    if response.headers.get("content-encoding", "identity") != "identity":
        raise FetchError(say("the answer is compressed"))
    found = bytearray()
    for piece in response.iter_raw():
        found += piece
        if len(found) > largest:
            raise TooLargeError(say("the answer is larger than {most} KiB", most=largest // 1024))
        if monotonic() > until:
            raise FetchError(say("the answer takes too long"))
    return bytes(found)


@cache
def _tls() -> ssl.SSLContext:
    # Memoized: making the settings takes longer than a request.
    return httpx.create_ssl_context(trust_env=False)


def _address(host: str, *, local: bool) -> IPv4Address | IPv6Address:
    try:
        found = {each[4][0] for each in socket.getaddrinfo(host, None, type=socket.SOCK_STREAM)}
        addresses = sorted((ip_address(each) for each in found), key=lambda it: (it.version, it))
    except (OSError, UnicodeError, ValueError) as error:
        raise FetchError(say("the name of the host is not known")) from error
    is_local = local and host in LOCAL_HOSTS
    if not addresses or not all(
        each.is_loopback if is_local else is_public(each) for each in addresses
    ):
        raise FetchError(say("the host has a private address"))
    return addresses[0]


def is_public(address: IPv4Address | IPv6Address) -> bool:
    """True if an address belongs to the public internet."""
    if isinstance(address, IPv6Address):
        if address.ipv4_mapped is not None:
            return is_public(address.ipv4_mapped)
        if any(address in network for network in _TRANSLATED):
            return False
    return address.is_global and not (address.is_multicast or address.is_reserved)
