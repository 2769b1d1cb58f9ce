"""What is known of the request that is being answered: its id, its route, when it came."""

import re
import secrets
from contextvars import ContextVar
from dataclasses import dataclass, field
from time import perf_counter
from typing import Final

# The header that names a request: a client's own id is kept, and comes back in the answer.
HEADER: Final = "X-Request-ID"
# As proxies and tracers write them; nothing that would have to be quoted in a log.
_WELL_FORMED: Final = re.compile(r"[A-Za-z0-9._:=+/-]{1,128}", re.ASCII)


@dataclass(slots=True)
class RequestContext:
    """One request. ``route`` is the pattern of its path, empty until it is found."""

    id: str
    route: str = ""
    came: float = field(default_factory=perf_counter)

    @property
    def seconds(self) -> float:
        """How long it has been here."""
        return perf_counter() - self.came


_current: ContextVar[RequestContext | None] = ContextVar("request", default=None)


def begin_request(wished: str | None = None) -> RequestContext:
    """Have what follows in this task belong to a new request; its id is ``wished`` if usable."""
    usable = wished is not None and _WELL_FORMED.fullmatch(wished)
    context = RequestContext(wished if usable and wished else secrets.token_hex(16))
    _current.set(context)
    return context


def current_request() -> RequestContext | None:
    """The request that this task answers; None outside of one."""
    return _current.get()


def end_request() -> None:
    """Have what follows belong to no request."""
    _current.set(None)
