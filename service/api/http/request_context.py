"""The request that is being answered: its id, its route, and when it arrived."""

import re
import secrets
from contextvars import ContextVar
from dataclasses import dataclass, field
from time import perf_counter
from typing import Final

from service.regex import regex

# The header with the id of a request. The id of a client is kept, and sent with the answer.
HEADER: Final = "X-Request-ID"
# Ids as proxies and tracers write them, without characters that a log would have to quote.
_WELL_FORMED: Final = regex(r"[A-Za-z0-9._:=+/-]{1,128}", re.ASCII)


@dataclass(slots=True)
class RequestContext:
    """A request; ``route`` is the pattern of its path, such as ``/v1/exercises/{exercise_id}``."""

    id: str
    route: str = ""
    arrived: float = field(default_factory=perf_counter)

    @property
    def seconds(self) -> float:
        """The seconds since the request arrived."""
        return perf_counter() - self.arrived


_current: ContextVar[RequestContext | None] = ContextVar("request", default=None)


def begin_request(wished: str | None = None) -> RequestContext:
    """Start a new request in the current task; ``wished`` is the id that the client asks for."""
    usable = wished is not None and _WELL_FORMED.fullmatch(wished)
    context = RequestContext(wished if usable and wished else secrets.token_hex(16))
    _current.set(context)
    return context


def current_request() -> RequestContext | None:
    """Return the request that the current task answers, or None."""
    return _current.get()


def end_request() -> None:
    """End the request of the current task."""
    _current.set(None)
