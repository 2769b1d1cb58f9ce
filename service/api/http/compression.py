"""Answers packed by gzip, where they are worth it: pages, scripts, drawings, descriptions."""

from typing import Final

from starlette.middleware.gzip import GZipMiddleware
from starlette.types import ASGIApp, Receive, Scope, Send

# Of nine; the higher ones take twice as long for a hundredth less.
_LEVEL: Final = 6


class PackedGets:
    """Packs the answers to GET for clients that take it.

    Those to POST, reports and previews, are small and have to be quick.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self._packed = GZipMiddleware(app, compresslevel=_LEVEL)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        is_get = scope["type"] == "http" and scope["method"] == "GET"
        await (self._packed if is_get else self.app)(scope, receive, send)
