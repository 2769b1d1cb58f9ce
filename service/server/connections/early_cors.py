"""Leave for pages of other sites to read what is answered before the application has a say."""

import re
from collections.abc import Mapping, Sequence
from typing import Final

from service.api.http.boundary import EXPOSED_HEADERS

_ORIGIN: Final = re.compile(rb"\r\nOrigin:[ \t]*([^\r\n]*?)[ \t]*\r\n", re.IGNORECASE)


def origin_in(head: bytes) -> str:
    """The origin that a head names, which may be cut off or no head; empty where it names none."""
    found = _ORIGIN.search(head)
    return found[1].decode("latin-1") if found else ""


def leave_to_read(origins: Sequence[str], origin: str) -> Mapping[str, str]:
    """The headers that let a page read the answer if it is of one of ``origins``.

    Where the request was refused before its ``origin`` came, the only one there is, is meant.
    """
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
