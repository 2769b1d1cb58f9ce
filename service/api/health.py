"""The routes that a supervisor asks."""

import asyncio
from http import HTTPStatus
from typing import TYPE_CHECKING, Final, Literal

from fastapi import APIRouter
from pydantic import BaseModel

from service.api.lookup import Catalogue
from service.api.openapi import refusals
from service.api.problems import store_down
from service.attempts.errors import StoreDownError

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

# So long the database may take to answer (seconds).
_PATIENCE: Final = 3.0


class Alive(BaseModel):
    """The process answers."""

    status: Literal["ok"] = "ok"


class Ready(BaseModel):
    """The catalogue is loaded."""

    status: Literal["ready"] = "ready"
    exercises: int


def routes(catalogue: Catalogue, store: "AttemptStore | None") -> APIRouter:
    """The routes that a supervisor asks."""
    router = APIRouter(tags=["health"])

    @router.get(
        "/healthz",
        operation_id="getLiveness",
        summary="Is the service alive?",
        response_description="It answers.",
    )
    async def alive() -> Alive:
        """Tell whether the process answers at all."""
        return Alive()

    @router.get(
        "/readyz",
        operation_id="getReadiness",
        summary="Is the service ready?",
        response_description="It is ready.",
        responses=refusals(HTTPStatus.SERVICE_UNAVAILABLE),
    )
    async def ready() -> Ready:
        """Tell whether submissions can be graded and, where there is a database, recorded."""
        if store is not None:
            try:
                await asyncio.wait_for(store.check(), _PATIENCE)
            except (StoreDownError, TimeoutError) as error:
                raise store_down("The database does not answer.") from error
        return Ready(exercises=len(catalogue))

    return router
