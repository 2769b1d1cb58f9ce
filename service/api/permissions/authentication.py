"""The layer at which a request says who asks, before it waits for its turn."""

from typing import Final, Protocol

from starlette.types import ASGIApp, Receive, Send
from starlette.types import Scope as Asked

from service.access.caller import Caller, Scope
from service.api.permissions.access import IDENTITY, Access
from service.api.permissions.access_problems import too_often
from service.api.turns import CLIENT, COURSE_SITE, ONE_ADDRESS, ONE_STUDENT, Client

# What counts towards limits, below whatever prefix the service stands; pages and files do not.
_COUNTED: Final = ("/v1/", "/tutor")
# Where a supervisor asks, who has no key and must not wait for the database of keys.
_HEALTH: Final = ("/healthz", "/readyz")


class RequestRates(Protocol):
    """Counts of requests."""

    async def seconds_to_wait(self, caller: Caller, address: str) -> int:
        """Count a request; 0 where it is allowed, else when to come again."""

    def close(self) -> None:
        """End."""


class DoorMiddleware:
    """Notes who asks, and refuses whoever asks too often."""

    def __init__(self, app: ASGIApp, access: Access, rates: RequestRates | None) -> None:
        self.app = app
        self._access = access
        self._rates = rates

    async def __call__(self, scope: Asked, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        if scope["type"] != "http" or scope["path"].endswith(_HEALTH):
            await self.app(scope, receive, send)
            return
        identity = await self._access.identify(scope)
        if self._rates is not None and any(each in scope["path"] for each in _COUNTED):
            address = (scope.get("client") or ("",))[0]
            seconds = await self._rates.seconds_to_wait(identity.caller, address)
            if seconds:
                await too_often(seconds).response(scope["path"])(scope, receive, send)
                return
        inner = {**scope, IDENTITY: identity}
        if identity.caller.owner:
            inner[CLIENT] = Client(identity.caller.owner, _most_shares(identity.caller))
        await self.app(inner, receive, send)


def _most_shares(caller: Caller) -> float:
    """Return how many shares of the processor the holder of a key or token has at most.

    A key that may record is that of a course site, which speaks for all students of the course.
    """
    if caller.learner is not None:
        return ONE_STUDENT
    return COURSE_SITE if Scope.RECORD in caller.scopes else ONE_ADDRESS
