"""The application: routes, limits and headers put together."""

import gc
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

from fastapi import Depends, FastAPI
from fastapi.routing import APIRoute
from starlette.middleware.cors import CORSMiddleware
from starlette.types import ASGIApp

from service.api.document.openapi import HEADING, OTHER_FAILURES, completed, work_out_schemas
from service.api.http import problems
from service.api.http.boundary import (
    EXPOSED_HEADERS,
    BoundaryMiddleware,
    NamingMiddleware,
    RefusalNoting,
    RouteNoting,
)
from service.api.http.compression import PackedGets
from service.api.http.lookup import Catalogue
from service.api.http.request_context import HEADER
from service.api.monitor import Monitor
from service.api.permissions.access import Access
from service.api.permissions.authentication import AuthenticationMiddleware, RequestRates
from service.api.permissions.rights import require_entries
from service.api.recording import listing as recorded
from service.api.recording import managing as tutoring
from service.api.recording import new_attempts as attempts
from service.api.routes import (
    exercises,
    figures,
    frames,
    grading,
    health,
    preview,
    reference,
    tokens,
)
from service.api.routes import solutions as model_solutions
from service.api.web_pages import WebPages
from service.catalogue import FeedbackLevel
from service.submissions.strict_json import MAX_BODY_SIZE
from service.version import VERSION

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

# What stands around an application.
Layer = Callable[[ASGIApp], ASGIApp]


def _freeze_gc() -> None:
    """Exempt the program's own objects from the garbage collector's rounds.

    A body of many small lists sets off full rounds; over the program itself, too, they took twice
    as long as reading the body. A process that starts without the collector has it from here on,
    and no first round, which takes as long as the ones it was spared.
    """
    if gc.isenabled():
        gc.collect()
    gc.freeze()
    gc.enable()


class _Api(FastAPI):
    """FastAPI with its outermost layers outside the framework's own error pages and limit."""

    def __init__(
        self,
        cors_origins: tuple[str, ...],
        turns: Layer | None,
        store: "AttemptStore | None",
        access: Access,
        rates: RequestRates | None,
        monitor: Monitor | None,
        pages: WebPages | None,
    ) -> None:
        self._cors_origins = cors_origins
        self._turns = turns
        self._store = store
        self._access = access
        self._rates = rates
        self._monitor = monitor
        self._pages = pages
        # The routes for programs, by which refusals are counted.
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
        if self._store is not None:
            self._store.start()
        _freeze_gc()
        yield
        if self._pages is not None:
            self._pages.close()
        self._access.close()
        if self._rates is not None:
            self._rates.close()
        if self._store is not None:
            self._store.close()

    def build_middleware_stack(self) -> ASGIApp:
        """The framework's layers, packed answers, turns between clients, the door, the boundary.

        Then CORS: a page may read problems, too. Outermost, so that whatever is answered has one,
        the id of the request.
        """
        app = super().build_middleware_stack()
        if self._monitor is not None:
            app = RouteNoting(app)
        app = PackedGets(app)
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
            app = self._monitor.watched(RefusalNoting(app, self.interface))
        return NamingMiddleware(app)

    def openapi(self) -> dict[str, Any]:
        """The description of the interface, made at the first call."""
        if self.openapi_schema is None:
            work_out_schemas()
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
) -> FastAPI:
    """The HTTP service for these exercises; pages of ``cors_origins`` may call it.

    ``access`` says who may do what; without it anybody may grade and record, and nobody see what
    tutors see. ``rates`` count requests. Reports tell no more than ``feedback``, nor than their
    exercise allows. ``turns`` decides who comes next, ``pages`` are the web pages of the service
    itself. Attempts are recorded in ``store``; without one none are. ``monitor`` counts what
    happens.
    """
    access = access or Access()
    app = _Api(cors_origins, turns, store, access, rates, monitor, pages)
    permitted = [Depends(access.permit)]
    problems.install(app, None if pages is None else pages.of_problem)
    for router in (
        exercises.routes(catalogue, feedback),
        grading.routes(catalogue, feedback, access, monitor),
        attempts.routes(catalogue, feedback, store, access, monitor, cors_origins),
        # Before the next one, to which /v1/attempts/export would be the id of an attempt.
        tutoring.routes(catalogue, feedback, store, access),
        recorded.routes(catalogue, store, access),
        preview.routes(catalogue, access),
        figures.routes(catalogue),
        frames.routes(catalogue, access),
        health.routes(catalogue, store),
        model_solutions.routes(catalogue),
        tokens.routes(catalogue, access),
    ):
        app.include_router(router, responses=OTHER_FAILURES, dependencies=permitted)
        app.interface += (route for route in router.routes if isinstance(route, APIRoute))
    app.include_router(reference.routes(), dependencies=permitted)
    if pages is not None:
        app.include_router(pages.routes, dependencies=permitted)
    require_entries(app.router)
    return app
