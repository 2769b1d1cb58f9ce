"""Check the address of a server, and make the options of an httpx client."""

from typing import Any, Final

import httpx

from service.regex import regex
from service.translations import say
from service.version import VERSION

# The characters of a token of ``Authorization: Bearer`` (RFC 6750).
_KEY: Final = regex(r"[A-Za-z0-9._~+/-]+=*")


def checked_server(server: str) -> str:
    """Return the address of a server without a trailing slash.

    Raises ValueError for an invalid address.
    """
    # A password in the address is invalid, because messages would show it.
    try:
        url = httpx.URL(server)
    except httpx.InvalidURL as error:
        raise ValueError(
            say(
                "{server!r} is not the address of a server: {reason}",
                server=server,
                reason=str(error),
            )
        ) from error
    if url.scheme not in ("http", "https") or not url.host or server.split() != [server]:
        raise ValueError(
            say(
                "{server!r} is not the address of a server; write https://grader.example.edu",
                server=server,
            )
        )
    if url.userinfo or url.query or url.fragment:
        raise ValueError(say("The address of a server has only scheme, host, port and path."))
    return str(url).rstrip("/")


def client_options(
    server: str, key: str | None, timeout: float, language: str | None = None
) -> dict[str, Any]:
    """Return the options of an httpx client for a checked server.

    Raises ValueError for a key with invalid characters.
    """
    # The message does not show the key.
    # No compression, so that the size of an answer is limited by the bytes received.
    headers = {"User-Agent": f"dh-grader/{VERSION}", "Accept-Encoding": "identity"}
    if language is not None:
        headers["Accept-Language"] = language
    if key is not None:
        if not _KEY.fullmatch(key):
            raise ValueError(
                say("The key is empty or has a character that no key has; copy it again.")
            )
        headers["Authorization"] = f"Bearer {key}"
    return {
        "base_url": server,
        "headers": headers,
        "timeout": timeout,
        "follow_redirects": False,
    }
