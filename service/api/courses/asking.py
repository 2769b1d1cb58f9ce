"""Helper functions for the routes of courses."""

from collections.abc import Callable
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Any, Final, TypeVar

from fastapi import Path, Request

from service.api.document.openapi import MAY_NEED_KEY, posting, refusals
from service.api.http.problems import ProblemError, message_of
from service.api.recording.store import ask
from service.contract.courses import CourseName
from service.courses.errors import CourseError, CourseFault
from service.translations import say

if TYPE_CHECKING:  # they load the drivers of databases
    from sqlalchemy import Connection

    from service.attempts.store import AttemptStore

R = TypeVar("R")

CourseId = Annotated[CourseName, Path(description="The id of a course.")]
AssignmentId = Annotated[CourseName, Path(description="The id of an assignment.")]

_TITLES: Final[dict[CourseFault, tuple[HTTPStatus, str]]] = {
    "unknown-course": (HTTPStatus.NOT_FOUND, say("There is no such course")),
    "unknown-assignment": (HTTPStatus.NOT_FOUND, say("There is no such assignment")),
    "unknown-learner": (HTTPStatus.NOT_FOUND, say("The course has no such learner")),
    "not-assigned": (HTTPStatus.NOT_FOUND, say("The exercise is not part of the assignment")),
    "has-attempts": (HTTPStatus.CONFLICT, say("Attempts are recorded there")),
    "already-there": (HTTPStatus.CONFLICT, say("There is one with this id already")),
    "unusable": (HTTPStatus.UNPROCESSABLE_ENTITY, say("The request cannot be used")),
}
_REFUSED: Final = (HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND, HTTPStatus.SERVICE_UNAVAILABLE)


def reading(model: type) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that reads data of a course."""
    refused = refusals(*_REFUSED, HTTPStatus.UNPROCESSABLE_ENTITY)
    return {"response_model": model, "responses": refused, "openapi_extra": MAY_NEED_KEY}


def changing(
    body: type, model: type, *further: HTTPStatus, success: HTTPStatus = HTTPStatus.OK
) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that changes data of a course.

    ``further`` are additional error statuses of the route.
    """
    options = posting(body, model, None, *_REFUSED, *further, success=success)
    return {"status_code": success, **options}


async def read(store: "AttemptStore | None", work: "Callable[[Connection], R]") -> R:
    """Call ``work`` to read from the database, and return the result.

    Raises ProblemError.
    """
    return await _done(store, work, writes=False)


async def write(store: "AttemptStore | None", work: "Callable[[Connection], R]") -> R:
    """Call ``work`` in a transaction of the database, and return the result.

    Raises ProblemError.
    """
    return await _done(store, work, writes=True)


async def _done(
    store: "AttemptStore | None", work: "Callable[[Connection], R]", *, writes: bool
) -> R:
    try:
        return await ask(store, lambda it: it.write(work) if writes else it.read(work))
    except CourseError as error:
        raise course_problem(error) from error


def service_address(request: Request) -> str:
    """Return the address with which links to this service begin, without a trailing slash."""
    # Without the setting, the header Host decides, which the caller's own browser sends.
    public_url: str | None = request.app.state.public_url
    return public_url or str(request.base_url).rstrip("/")


def course_problem(error: CourseError) -> ProblemError:
    """Convert a CourseError to an HTTP error."""
    status, title = _TITLES[error.name]
    return ProblemError(status, message_of(error), error.name, title)
