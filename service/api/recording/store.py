"""The store of attempts as the routes of tutors ask it."""

from collections.abc import Awaitable, Callable
from http import HTTPStatus
from typing import TYPE_CHECKING, TypeVar

from fastapi import Response
from pydantic import BaseModel

from service.api.http.problems import ProblemError, store_down
from service.api.recording.new_attempts import not_recorded
from service.attempts.errors import StoreDownError

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

R = TypeVar("R")


async def ask(
    store: "AttemptStore | None", question: Callable[["AttemptStore"], Awaitable[R]]
) -> R:
    """What the store answers. Raises ProblemError where there is none, or where it is down."""
    if store is None:
        raise not_recorded()
    try:
        return await question(store)
    except StoreDownError as error:
        detail = "The database does not answer."
        raise store_down(detail) from error


def unknown_attempt() -> ProblemError:
    """No attempt has the id, or none that may be seen by who asks."""
    return ProblemError(
        HTTPStatus.NOT_FOUND,
        "No attempt with this id is recorded here.",
        "unknown-attempt",
        "There is no such attempt",
    )


def private(model: BaseModel) -> Response:
    """An answer that nobody keeps on the way."""
    return private_json(model.model_dump_json(exclude_none=True).encode())


def private_json(content: bytes) -> Response:
    """The same of JSON that is written already."""
    return Response(content, HTTPStatus.OK, {"Cache-Control": "no-store"}, "application/json")
