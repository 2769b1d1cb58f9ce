"""CORS headers for requests that are refused before they reach the application."""

import re
from collections.abc import Mapping, Sequence
from typing import Final

from service.api.http.boundary import EXPOSED_HEADERS
from service.regex import regex

_ORIGIN: Final = regex(rb"\r\nOrigin:[ \t]*([^\r\n]*?)[ \t]*\r\n", re.IGNORECASE)


def origin_in(head: bytes) -> str:
    """Return the origin in a request's head, or "". The head may be incomplete or invalid."""
    found = _ORIGIN.search(head)
    return found[1].decode("latin-1") if found else ""


def cors_headers(origins: Sequence[str], origin: str) -> Mapping[str, str]:
    """Return the headers that allow a page of ``origin`` to read the response."""
    # ``origin`` is "" if the request was refused before its head was read. In this case, the only
    # entry of ``origins`` is used, if there is only one.
    if "*" in origins:
        allowed = "*"
    elif origin in origins:
        allowed = origin
    elif not origin and len(origins) == 1:
        allowed = origins[0]
    else:
        return {}
    return {
        "Access-Control-Allow-Origin": allowed,
        "Access-Control-Expose-Headers": ", ".join(EXPOSED_HEADERS),
        "Vary": "Origin",
    }
