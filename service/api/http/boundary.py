"""The outermost layers, which every request and answer passes."""

from collections.abc import Sequence
from typing import Final

from fastapi import Request
from fastapi.routing import APIRoute
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.http.problems import too_large
from service.api.http.request_context import HEADER, begin_request, current_request
from service.submissions.strict_json import MAX_BODY_SIZE

# What a page of another origin may read of an answer besides its body.
EXPOSED_HEADERS: Final = ("Retry-After", HEADER)
_DIGITS: Final = len(str(MAX_BODY_SIZE))


class NamingMiddleware:
    """Gives every request its id, and tells it in the answer."""

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


class RouteNoting:
    """Notes which route the application has found for a request."""

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


class RefusalNoting:
    """Notes which of these routes a request was for that a layer before the routes refused."""

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
    """Hardens answers, has HEAD answered as GET, and refuses a body that says it is too large.

    The framework's own limit counts the bytes as they come; where a length is declared, nothing
    need be read, and an address that takes no body refuses it as well.
    """

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
                # No page of another origin shows or runs it, but what says otherwise: the element's
                # files, and figures. Pages of DH_GRADER_CORS_ORIGINS ask in a mode that may.
                headers.setdefault("Cross-Origin-Resource-Policy", "same-origin")
            await send(message)

        if _is_too_large(Headers(scope=scope).get("content-length", "")):
            answer = too_large().response(Request(scope).url.path)
            await answer(scope, receive, hardened)
            return
        # The server still knows that it was HEAD, and sends the headers alone.
        inner = {**scope, "method": "GET"} if scope["method"] == "HEAD" else scope
        await self.app(inner, receive, hardened)


def _is_too_large(declared: str) -> bool:
    """True if a header Content-Length declares more than a body may hold."""
    if not (declared.isascii() and declared.isdigit()):
        return False
    # int() refuses more than 4,300 digits, and zeros may precede a length.
    digits = declared.lstrip("0")
    return len(digits) > _DIGITS or int(digits or "0") > MAX_BODY_SIZE
