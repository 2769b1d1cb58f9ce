"""Build the HTTP service from its routes, limits and headers."""

import asyncio
import gc
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

from fastapi import Depends, FastAPI
from fastapi.routing import APIRoute
from starlette.middleware.cors import CORSMiddleware
from starlette.types import ASGIApp

from service.api.courses import (
    assignments,
    deletion,
    gradebook,
    handing_in,
    links,
    paid_hints,
    rolls,
    scores,
)
from service.api.courses.own_variant import OwnVariants
from service.api.courses.practice import PracticeGate
from service.api.document.openapi import HEADING, OTHER_FAILURES, completed, fill_body_schemas
from service.api.http import problems
from service.api.http.boundary import (
    EXPOSED_HEADERS,
    BoundaryMiddleware,
    RefusedRouteMiddleware,
    RequestIdMiddleware,
    RouteMiddleware,
)
from service.api.http.compression import CompressedGets
from service.api.http.lookup import Catalogue
from service.api.http.request_context import HEADER
from service.api.monitor import Monitor
from service.api.permissions.access import Access
from service.api.permissions.authentication import AuthenticationMiddleware, RequestRates
from service.api.recording import listing as recorded
from service.api.recording import managing as tutoring
from service.api.recording import new_attempts as attempts
from service.api.routes import (
    exercises,
    figures,
    frames,
    grading,
    health,
    hints,
    practice,
    preview,
    reference,
    tokens,
)
from service.api.routes import solutions as model_solutions
from service.api.web_pages import WebPages
from service.catalogue import FeedbackLevel, LateCatalogue
from service.catalogue.drafts import CatalogueWithDrafts
from service.submissions.strict_json import MAX_BODY_SIZE
from service.variants.robots.practice_catalogue import CatalogueWithPractice
from service.version import VERSION

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore
    from service.lti.scores.sending import BackgroundSending

# Puts a layer around an application.
Layer = Callable[[ASGIApp], ASGIApp]


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


def _sending(
    store: "AttemptStore", access: Access, catalogue: Catalogue
) -> "Iterable[BackgroundSending]":
    secret = None if access.keys is None else access.keys.secret
    if secret is None:
        return
    # Imported only here, because they import the database drivers.
    from service.attempts.storage.score_queue import QUEUED
    from service.lti.handed_files import queue
    from service.lti.handed_files.file_reporting import FileReporting
    from service.lti.scores.sender import ScoreSender
    from service.lti.scores.sending import BackgroundSending

    engine = store.engine
    yield BackgroundSending(engine, ScoreSender(engine, secret), QUEUED)
    yield BackgroundSending(engine, FileReporting(engine, secret, catalogue), queue.QUEUED)


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
    problems.install(app, None if pages is None else pages.of_problem)
    # What is recorded, and every other list, has no drafts and no generated robots.
    practised = CatalogueWithPractice(catalogue)
    seen = practised if pages is None else CatalogueWithDrafts(practised, pages.drafts)
    own, gate = OwnVariants(store, access), PracticeGate(store, catalogue)
    for router in (
        exercises.routes(seen, feedback, own),
        practice.routes(practised),
        grading.routes(seen, feedback, access, monitor, gate, own),
        hints.routes(seen, feedback, access, gate, own),
        attempts.routes(catalogue, feedback, store, access, gate.check, monitor, cors_origins),
        # Before the next router, for which the "export" of /v1/attempts/export is an attempt's id.
        tutoring.routes(catalogue, feedback, store, access),
        recorded.routes(catalogue, store, access),
        preview.routes(seen, access, own),
        figures.routes(seen, own),
        frames.routes(seen, access, own),
        health.routes(catalogue, store),
        model_solutions.routes(practised, access, gate, own),
        tokens.routes(catalogue, access),
        rolls.routes(store, access),
        links.routes(store, access),
        deletion.routes(store),
        assignments.routes(catalogue, store),
        gradebook.routes(catalogue, store),
        scores.routes(store),
        handing_in.routes(catalogue, feedback, store, access, monitor, cors_origins),
        paid_hints.routes(catalogue, feedback, store, access, cors_origins),
    ):
        app.include_router(router, responses=OTHER_FAILURES, dependencies=permitted)
        app.interface += (route for route in router.routes if isinstance(route, APIRoute))
    app.include_router(reference.routes(), dependencies=permitted)
    if pages is not None:
        app.include_router(pages.routes, dependencies=permitted)
    return app
