"""The application: routes, limits and headers put together."""

import gc
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

from fastapi import APIRouter, FastAPI
from starlette.middleware.cors import CORSMiddleware
from starlette.types import ASGIApp

from service.api import exercises, figures, frames, grading, health, preview, problems, reference
from service.api import solutions as model_solutions
from service.api.boundary import BoundaryMiddleware
from service.api.compression import PackedGets
from service.api.lookup import Catalogue
from service.api.openapi import HEADING, completed, other_failures
from service.api.tutor import tutor_right
from service.catalogue import FeedbackLevel
from service.submissions.strict_json import MAX_BODY_SIZE
from service.version import VERSION

# What stands around an application.
Layer = Callable[[ASGIApp], ASGIApp]


@asynccontextmanager
async def _freeze_gc(_: FastAPI) -> AsyncIterator[None]:
    """Exempt the program's own objects from the garbage collector's rounds.

    A body of many small lists sets off full rounds; over the program itself, too, they took twice
    as long as reading the body.
    """
    gc.collect()
    gc.freeze()
    yield


class _Api(FastAPI):
    """FastAPI with its outermost layers outside the framework's own error pages and limit."""

    def __init__(self, cors_origins: tuple[str, ...], turns: Layer | None) -> None:
        self._cors_origins = cors_origins
        self._turns = turns
        super().__init__(
            **HEADING,
            version=VERSION,
            docs_url=None,
            redoc_url=None,
            redirect_slashes=False,
            max_body_size=MAX_BODY_SIZE,
            lifespan=_freeze_gc,
        )

    def build_middleware_stack(self) -> ASGIApp:
        """The framework's layers, packed answers, the turns between clients, the boundary.

        Then CORS: a page may read problems, too.
        """
        app: ASGIApp = PackedGets(super().build_middleware_stack())
        if self._turns is not None:
            app = self._turns(app)
        app = BoundaryMiddleware(app)
        if self._cors_origins:
            app = CORSMiddleware(
                app,
                allow_origins=self._cors_origins,
                allow_methods=["GET", "POST"],
                allow_headers=["Content-Type"],
                expose_headers=["Retry-After"],
            )
        return app

    def openapi(self) -> dict[str, Any]:
        """The description of the interface, made at the first call."""
        if self.openapi_schema is None:
            self.openapi_schema = completed(super().openapi())
        return self.openapi_schema


def application(
    catalogue: Catalogue,
    cors_origins: tuple[str, ...] = (),
    *,
    solutions: bool | None = False,
    feedback: FeedbackLevel = FeedbackLevel.FULL,
    turns: Layer | None = None,
    pages: APIRouter | None = None,
) -> FastAPI:
    """The HTTP service for these exercises; pages of ``cors_origins`` may call it.

    With ``solutions`` it shows the model solutions to whoever asks; None means whoever asks from
    this machine. Reports tell no more than
    ``feedback``, nor than their exercise allows. ``turns`` decides who comes next, ``pages`` are
    the web pages of the service itself.
    """
    app = _Api(cors_origins, turns)
    problems.install(app)
    for router in (
        exercises.routes(catalogue, feedback),
        grading.routes(catalogue, feedback),
        preview.routes(catalogue),
        figures.routes(catalogue),
        frames.routes(catalogue),
        health.routes(catalogue),
        model_solutions.routes(catalogue, tutor_right(solutions)),
    ):
        app.include_router(router, responses=other_failures())
    app.include_router(reference.routes())
    if pages is not None:
        app.include_router(pages)
    return app
