"""Compression of responses with gzip."""

from typing import Final

from starlette.middleware.gzip import GZipMiddleware
from starlette.types import ASGIApp, Receive, Scope, Send

# Of nine levels. Higher ones take twice as long and save 1 %.
_LEVEL: Final = 6


class CompressedGets:
    """Compress the responses to GET for clients that accept gzip."""

    # The responses to POST are small and must be fast, so they are not compressed.

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self._packed = GZipMiddleware(app, compresslevel=_LEVEL)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        is_get = scope["type"] == "http" and scope["method"] == "GET"
        await (self._packed if is_get else self.app)(scope, receive, send)
