"""Access to the recorded attempts for routes, with errors as HTTP responses."""

from collections.abc import Awaitable, Callable
from http import HTTPStatus
from typing import TYPE_CHECKING, Final, TypeVar

from fastapi import Response
from pydantic import BaseModel

from service.api.http.problems import ProblemError, store_down
from service.api.recording.new_attempts import not_recorded
from service.attempts.errors import StoreDownError
from service.translations import say

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

R = TypeVar("R")

NO_STORE: Final = {"Cache-Control": "no-store"}


async def ask(
    store: "AttemptStore | None", question: Callable[["AttemptStore"], Awaitable[R]]
) -> R:
    """Call ``question`` with the store of attempts; return the result.

    Raises ProblemError if the database is missing or does not respond.
    """
    if store is None:
        raise not_recorded()
    try:
        return await question(store)
    except StoreDownError as error:
        detail = say("The database does not answer.")
        raise store_down(detail) from error


def unknown_attempt() -> ProblemError:
    """Return the error for an attempt that is unknown or that the caller may not see."""
    return ProblemError(
        HTTPStatus.NOT_FOUND,
        say("No attempt with this id is recorded here."),
        "unknown-attempt",
        say("There is no such attempt"),
    )


def private(model: BaseModel) -> Response:
    """Return the model as a JSON response that no cache may store."""
    return private_json(model.model_dump_json(exclude_none=True).encode())


def private_json(content: bytes) -> Response:
    """Return JSON as a response that no cache may store."""
    return Response(content, HTTPStatus.OK, NO_STORE, "application/json")
