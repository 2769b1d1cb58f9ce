"""Middleware that authenticates the callers of requests and limits their rates."""

from collections.abc import Awaitable, Callable
from functools import partial
from typing import Final, Protocol

from fastapi import Request
from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Send
from starlette.types import Scope as AsgiScope

from service.access.caller import Caller, Scope
from service.api.http.language import language_of
from service.api.permissions.access import IDENTITY, Access
from service.api.permissions.access_problems import access_problem
from service.api.turns import CLIENT, COURSE_SITE, ONE_ADDRESS, ONE_STUDENT, Client

# Parts of the paths that count towards limits, after any prefix of a proxy; pages and files do not.
_COUNTED: Final = ("/v1/", "/tutor", "/lti/")
# Supervisors have no key, and must not wait for the database of keys.
_HEALTH: Final = ("/healthz", "/readyz")


# The key of a request's ASGI scope under which the authentication leaves a function that counts
# submissions towards the caller's limit.
COUNT: Final = "dh_grader.count"


class RequestRates(Protocol):
    """Counts the requests of callers, to limit their rates."""

    def most_at_once(self, caller: Caller) -> float:
        """Return the most requests that may be counted for the caller at once."""

    async def seconds_to_wait(self, caller: Caller, address: str, requests: int = 1) -> int:
        """Count requests; return 0 if they are allowed, otherwise the seconds to wait."""

    def close(self) -> None:
        """Stop the counting threads."""


class AuthenticationMiddleware:
    """Authenticate the caller of each request, and enforce the caller's rate limit."""

    def __init__(self, app: ASGIApp, access: Access, rates: RequestRates | None) -> None:
        self.app = app
        self._access = access
        self._rates = rates

    async def __call__(self, scope: AsgiScope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        if scope["type"] != "http" or scope["path"].endswith(_HEALTH):
            await self.app(scope, receive, send)
            return
        identity = await self._access.identify(scope)
        if self._rates is not None and any(each in scope["path"] for each in _COUNTED):
            address = (scope.get("client") or ("",))[0]
            seconds = await self._rates.seconds_to_wait(identity.caller, address)
            if seconds:
                refused = access_problem("too-often", seconds=seconds)
                await refused.response(scope["path"], language_of(HTTPConnection(scope)))(
                    scope, receive, send
                )
                return
            scope = {**scope, COUNT: partial(_count, self._rates, identity.caller, address)}
        inner = {**scope, IDENTITY: identity}
        if identity.caller.owner:
            inner[CLIENT] = Client(identity.caller.owner, _most_shares(identity.caller))
        await self.app(inner, receive, send)


async def count_submissions(request: Request, number: int) -> None:
    """Count each submission of a batch as a request of the caller.

    Raises ProblemError if the caller's limit does not allow the whole batch.
    """
    count: Callable[[int], Awaitable[None]] | None = request.scope.get(COUNT)
    if count is not None:
        await count(number)


async def _count(rates: RequestRates, caller: Caller, address: str, number: int) -> None:
    most = rates.most_at_once(caller)
    if number > most:
        raise access_problem("batch-too-large", number=number, most=int(most))
    # The request itself has been counted.
    seconds = await rates.seconds_to_wait(caller, address, number - 1) if number > 1 else 0
    if seconds:
        raise access_problem("too-often", seconds=seconds)


def _most_shares(caller: Caller) -> float:
    # A key that may record counts as the key of a course site, which acts for all its students.
    if caller.learner is not None:
        return ONE_STUDENT
    return COURSE_SITE if Scope.RECORD in caller.scopes else ONE_ADDRESS
