"""The HTTP service as a whole: ``application`` puts routes, middleware and threads together.

It knows the order of the routes and of the middleware. The routes are in the other files.
"""

import asyncio
import gc
from collections.abc import AsyncIterator, Callable, Iterable, Sequence
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from fastapi import APIRouter, Depends, FastAPI, Request
from fastapi.routing import APIRoute
from starlette.datastructures import Headers, MutableHeaders
from starlette.middleware.cors import CORSMiddleware
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from dh_grader import VERSION
from dh_grader.api import courses, frames, grading, http, recording
from dh_grader.api.document import (
    HEADING,
    OTHER_FAILURES,
    completed,
    fill_body_schemas,
    reference_routes,
)
from dh_grader.api.grading_gates import OwnVariants, PracticeGate
from dh_grader.api.http import (
    HEADER,
    Catalogue,
    CompressedGets,
    Monitor,
    ProblemPage,
    begin_request,
    current_request,
    language_of,
    too_large,
)
from dh_grader.api.permissions import Access, AuthenticationMiddleware, RequestRates
from dh_grader.catalogue import FeedbackLevel, LateCatalogue
from dh_grader.catalogue.load import CatalogueWithDrafts, Drafts
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from dh_grader.variants.robots import CatalogueWithPractice

if TYPE_CHECKING:
    from dh_grader.lti.outbox import BackgroundSending
    from dh_grader.store.attempt_store import AttemptStore


# --- The service: its routes, its middleware, and what runs as long as it does

# The headers of an answer that a page of another origin may read.
EXPOSED_HEADERS: Final = ("Retry-After", HEADER)
# Puts a layer around an application.
Layer = Callable[[ASGIApp], ASGIApp]


class WebPages(NamedTuple):
    """The routes of the web pages, with functions and data for the application.

    ``of_problem`` makes an HTML page from an error response. ``drafts`` are the exercises that
    tutors preview.
    """

    routes: APIRouter
    of_problem: ProblemPage
    close: Callable[[], None]
    drafts: Drafts


def application(
    catalogue: Catalogue,
    cors_origins: tuple[str, ...] = (),
    *,
    access: Access | None = None,
    rates: RequestRates | None = None,
    feedback: FeedbackLevel = FeedbackLevel.FULL,
    turns: Layer | None = None,
    store: "AttemptStore | None" = None,
    pages: WebPages | None = None,
    monitor: Monitor | None = None,
    public_url: str | None = None,
) -> FastAPI:
    """Return the HTTP service for the exercises of ``catalogue``.

    ``access`` authenticates callers. Without ``access``, everybody may grade and record, and nobody
    sees the data for tutors. ``feedback`` is the highest feedback level of reports. Attempts are
    recorded in ``store``. Personal links begin with ``public_url``, or else with the address of the
    request.
    """
    access = access or Access()
    app = _Api(catalogue, cors_origins, turns, store, access, rates, monitor, pages)
    app.state.public_url = public_url
    permitted = [Depends(access.permit)]
    http.install(app, None if pages is None else pages.of_problem)
    # What is recorded, and every other list, has no drafts and no generated robots.
    practised = CatalogueWithPractice(catalogue)
    seen = practised if pages is None else CatalogueWithDrafts(practised, pages.drafts)
    own, gate = OwnVariants(store, access), PracticeGate(store, catalogue)
    for router in (
        grading.exercises_routes(seen, feedback, own),
        grading.practice_routes(practised),
        grading.grading_routes(seen, feedback, access, monitor, gate, own),
        grading.hints_routes(seen, feedback, access, gate, own),
        recording.new_attempts_routes(
            catalogue, feedback, store, access, gate.check, monitor, cors_origins
        ),
        # Before the next router, for which the "export" of /v1/attempts/export is an attempt's id.
        recording.managing_routes(catalogue, feedback, store, access),
        recording.listing_routes(catalogue, store, access),
        frames.preview_routes(seen, access, own),
        frames.figures_routes(seen, own),
        frames.frames_routes(seen, access, own),
        grading.health_routes(catalogue, store),
        grading.solutions_routes(practised, access, gate, own),
        grading.tokens_routes(catalogue, access),
        courses.rolls_routes(store, access),
        courses.links_routes(store, access),
        courses.deletion_routes(store),
        courses.assignments_routes(catalogue, store),
        courses.gradebook_routes(catalogue, store),
        courses.scores_routes(store),
        courses.handing_in_routes(catalogue, feedback, store, access, monitor, cors_origins),
        courses.paid_hints_routes(catalogue, feedback, store, access, cors_origins),
    ):
        app.include_router(router, responses=OTHER_FAILURES, dependencies=permitted)
        app.interface += (route for route in router.routes if isinstance(route, APIRoute))
    app.include_router(reference_routes(), dependencies=permitted)
    if pages is not None:
        app.include_router(pages.routes, dependencies=permitted)
    return app


class _Api(FastAPI):
    def __init__(
        self,
        catalogue: Catalogue,
        cors_origins: tuple[str, ...],
        turns: Layer | None,
        store: "AttemptStore | None",
        access: Access,
        rates: RequestRates | None,
        monitor: Monitor | None,
        pages: WebPages | None,
    ) -> None:
        self._catalogue = catalogue
        self._cors_origins = cors_origins
        self._turns = turns
        self._store = store
        self._access = access
        self._rates = rates
        self._monitor = monitor
        self._pages = pages
        # The routes for programs, to which refusals are counted.
        self.interface: list[APIRoute] = []
        super().__init__(
            **HEADING,
            version=VERSION,
            docs_url=None,
            redoc_url=None,
            redirect_slashes=False,
            max_body_size=MAX_BODY_SIZE,
            lifespan=self._lifespan,
        )

    @asynccontextmanager
    async def _lifespan(self, _: FastAPI) -> AsyncIterator[None]:
        sending: list[BackgroundSending] = []
        if self._store is not None:
            sending += _sending(self._store, self._access, self._catalogue)
            self._store.start()
        for each in sending:
            each.start()
        _freeze_gc()
        compiling = asyncio.create_task(_compile_rest(self._catalogue))
        yield
        compiling.cancel()
        for each in sending:
            each.close()
        if self._pages is not None:
            self._pages.close()
        self._access.close()
        if self._rates is not None:
            self._rates.close()
        if self._store is not None:
            self._store.close()

    def build_middleware_stack(self) -> ASGIApp:
        # The CORS layer is outside the others except the request's id, so that pages of other
        # origins may also read error responses.
        app = super().build_middleware_stack()
        if self._monitor is not None:
            app = RouteMiddleware(app)
        app = CompressedGets(app)
        if self._turns is not None:
            app = self._turns(app)
        if self._access.keys is not None or self._rates is not None:
            app = AuthenticationMiddleware(app, self._access, self._rates)
        app = BoundaryMiddleware(app)
        if self._cors_origins:
            app = CORSMiddleware(
                app,
                allow_origins=self._cors_origins,
                allow_methods=["GET", "POST"],
                allow_headers=["Authorization", "Content-Type", "Idempotency-Key", HEADER],
                expose_headers=EXPOSED_HEADERS,
            )
        if self._monitor is not None:
            app = self._monitor.watched(RefusedRouteMiddleware(app, self.interface))
        return RequestIdMiddleware(app)

    def openapi(self) -> dict[str, Any]:
        if self.openapi_schema is None:
            fill_body_schemas()
            self.openapi_schema = completed(super().openapi())
        return self.openapi_schema


def _sending(
    store: "AttemptStore", access: Access, catalogue: Catalogue
) -> "Iterable[BackgroundSending]":
    secret = None if access.keys is None else access.keys.secret
    if secret is None:
        return
    # Imported only here, because they import the database drivers.
    from dh_grader.lti import handed_files
    from dh_grader.lti.outbox import BackgroundSending, ScoreSender
    from dh_grader.store.database import QUEUED

    engine = store.engine
    yield BackgroundSending(engine, ScoreSender(engine, secret), QUEUED)
    reporting = handed_files.FileReporting(engine, secret, catalogue)
    yield BackgroundSending(engine, reporting, handed_files.QUEUED)


def _freeze_gc() -> None:
    # Reading a request body with many small lists triggers full collections. Without freezing, they
    # would also visit the objects of the program, and take twice as long as reading the body.
    if gc.isenabled():
        gc.collect()
    gc.freeze()
    gc.enable()


async def _compile_rest(catalogue: Catalogue) -> None:
    # One at a time, so that the first requests need not wait for all.
    if isinstance(catalogue, LateCatalogue):
        for _ in catalogue.compile_one_by_one():
            await asyncio.sleep(0)
        gc.collect()
        gc.freeze()


# --- The outermost middleware, which every request and response passes


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
