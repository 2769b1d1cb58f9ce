"""The routes for health checks."""

import asyncio
from http import HTTPStatus
from typing import TYPE_CHECKING, Final, Literal

from fastapi import APIRouter
from pydantic import BaseModel

from service.api.document.openapi import refusals
from service.api.http.lookup import Catalogue
from service.api.http.problems import ProblemError, store_down
from service.attempts.errors import StoreDownError
from service.translations import say

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

# The seconds that the database may take to answer.
_PATIENCE: Final = 3.0


class Alive(BaseModel):
    """The answer of a process that is alive."""

    status: Literal["ok"] = "ok"


class Ready(BaseModel):
    """The answer of a service with exercises."""

    status: Literal["ready"] = "ready"
    exercises: int


def routes(catalogue: Catalogue, store: "AttemptStore | None") -> APIRouter:
    """Return the routes for health checks."""
    router = APIRouter(tags=["health"])
    checks = None if store is None else _Checks(store)

    @router.get(
        "/healthz",
        operation_id="getLiveness",
        summary="Is the service alive?",
        response_description="It answers.",
    )
    async def alive() -> Alive:
        """Answer if the process is alive."""
        return Alive()

    @router.get(
        "/readyz",
        operation_id="getReadiness",
        summary="Is the service ready?",
        response_description="It is ready.",
        responses=refusals(HTTPStatus.SERVICE_UNAVAILABLE),
    )
    async def ready() -> Ready:
        """Say whether the service can grade submissions and, if it has a database, record them."""
        exercises = len(catalogue)
        if not exercises:
            raise _no_exercises()
        if checks is not None:
            try:
                await checks.passed()
            except StoreDownError as error:
                raise store_down(say("The database does not answer.")) from error
        return Ready(exercises=exercises)

    return router


class _Checks:
    # Checks the database once at a time; requests that arrive during a check share it.
    def __init__(self, store: "AttemptStore") -> None:
        self._store = store
        self._under_way: asyncio.Task[None] | None = None

    async def passed(self) -> None:
        if self._under_way is None or self._under_way.done():
            self._under_way = asyncio.create_task(self._check())
        # If one client goes away, the others still wait for the check.
        await asyncio.shield(self._under_way)

    async def _check(self) -> None:
        try:
            await asyncio.wait_for(self._store.check(), _PATIENCE)
        except TimeoutError as error:
            raise StoreDownError(f"the database does not react within {_PATIENCE:g} s") from error


def _no_exercises() -> ProblemError:
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        "No exercise is loaded.",
        "no-exercises",
        "The service has nothing to grade",
        headers={"Retry-After": "5"},
    )
