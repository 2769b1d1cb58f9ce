"""The routes that a supervisor asks."""

from typing import Literal

from fastapi import APIRouter
from pydantic import BaseModel

from service.api.lookup import Catalogue


class Alive(BaseModel):
    """The process answers."""

    status: Literal["ok"] = "ok"


class Ready(BaseModel):
    """The catalogue is loaded."""

    status: Literal["ready"] = "ready"
    exercises: int


def routes(catalogue: Catalogue) -> APIRouter:
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
    )
    async def ready() -> Ready:
        """Tell whether submissions can be graded, and how many exercises there are."""
        return Ready(exercises=len(catalogue))

    return router
