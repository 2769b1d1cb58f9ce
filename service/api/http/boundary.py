"""The outermost middleware, which every request and response passes."""

from collections.abc import Sequence
from typing import Final

from fastapi import Request
from fastapi.routing import APIRoute
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.http.language import language_of
from service.api.http.problems import too_large
from service.api.http.request_context import HEADER, begin_request, current_request
from service.submissions.strict_json import MAX_BODY_SIZE

# The headers of an answer that a page of another origin may read.
EXPOSED_HEADERS: Final = ("Retry-After", HEADER)
_DIGITS: Final = len(str(MAX_BODY_SIZE))


class RequestIdMiddleware:
    """Give every request an id, and send the id with the response."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        request = begin_request(Headers(scope=scope).get(HEADER))

        async def named(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)[HEADER] = request.id
            await send(message)

        await self.app(scope, receive, named)


class RouteMiddleware:
    """Store the route of each request for the log and the metrics."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        try:
            await self.app(scope, receive, send)
        finally:
            request = current_request()
            if request is not None:
                request.route = getattr(scope.get("route"), "path", "")


class RefusedRouteMiddleware:
    """Store the route of a request that other middleware has refused."""

    def __init__(self, app: ASGIApp, routes: Sequence[APIRoute]) -> None:
        self.app = app
        self._routes = routes

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        try:
            await self.app(scope, receive, send)
        finally:
            request = current_request()
            if request is not None and not request.route:
                request.route = self._route(scope["method"], scope["path"])

    def _route(self, method: str, path: str) -> str:
        found = (
            route.path
            for route in self._routes
            if method in (route.methods or ()) and route.path_regex.match(path)
        )
        return next(found, "")


class BoundaryMiddleware:
    """Add security headers, answer HEAD like GET, and refuse large request bodies."""

    # FastAPI's own limit counts the bytes of a body as they arrive. This layer reads only the
    # header Content-Length, also on routes that take no body.

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def hardened(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers["X-Content-Type-Options"] = "nosniff"
                # No page of another origin may embed the answer. The element's files and figures
                # set their own value; pages of DH_GRADER_CORS_ORIGINS use CORS.
                headers.setdefault("Cross-Origin-Resource-Policy", "same-origin")
            await send(message)

        if _is_too_large(Headers(scope=scope).get("content-length", "")):
            answer = too_large().response(Request(scope).url.path, language_of(Request(scope)))
            await answer(scope, receive, hardened)
            return
        # The server still knows that the method is HEAD, and sends only the headers.
        inner = {**scope, "method": "GET"} if scope["method"] == "HEAD" else scope
        await self.app(inner, receive, hardened)


def _is_too_large(declared: str) -> bool:
    if not (declared.isascii() and declared.isdigit()):
        return False
    # int() refuses more than 4,300 digits, and zeros may precede a length.
    digits = declared.lstrip("0")
    return len(digits) > _DIGITS or int(digits or "0") > MAX_BODY_SIZE
