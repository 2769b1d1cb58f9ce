"""Error responses in the format of RFC 9457 (problem details)."""

import json
import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any, Final

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.routing import iter_route_contexts
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from service.api.http.language import language_of
from service.api.http.request_context import current_request
from service.api.http.told_answer import language_headers
from service.contract.problems import MEDIA_TYPE, TYPE_PREFIX, general_name
from service.submissions.field_errors import field_error
from service.submissions.strict_json import MAX_BODY_SIZE
from service.translations import ENGLISH, Language, Sentence, paragraph, say, told

MAX_ERRORS = 20
STORE_DOWN: Final = "store-down"

_log = logging.getLogger(__name__)

Detail = Mapping[str, str | int]


@dataclass(eq=False)
class ProblemError(Exception):
    """An error that is sent as the response; its attributes are the fields of the response.

    ``name`` is the last part of the problem type (RFC 9457), one of ``PROBLEM_TYPES``; without a
    name, the problem has the general type of its status. ``challenges`` are the headers
    ``WWW-Authenticate``.
    """

    # A Sentence in ``title`` or ``detail`` is translated for the reader.

    status: HTTPStatus
    detail: str
    name: str = ""
    title: str = ""
    errors: Sequence[Detail] = ()
    headers: Mapping[str, str] | None = None
    challenges: Sequence[str] = ()

    def response(self, instance: str, language: Language = ENGLISH) -> Response:
        """Return the error response to a request for the path ``instance``."""
        request = current_request()
        content = self.content(instance, "" if request is None else request.id, language)
        answer = self.answer(content, MEDIA_TYPE)
        if isinstance(self.detail, Sentence) or isinstance(self.title, Sentence):
            answer.headers.update(language_headers(language))
        return answer

    def answer(self, content: bytes, media_type: str = "text/html") -> Response:
        """Return a response with this content, and with the error's status and headers."""
        response = Response(content, self.status, self.headers, media_type)
        for challenge in self.challenges:
            response.headers.append("WWW-Authenticate", challenge)
        return response

    def content(self, instance: str, request_id: str = "", language: Language = ENGLISH) -> bytes:
        """Return the error as JSON; ``instance`` is the path that was requested."""
        translation = language.translation
        document: dict[str, Any] = {
            "type": TYPE_PREFIX + (self.name or general_name(self.status)),
            "title": told(self.title or self.status.phrase, translation),
            "status": int(self.status),
            "detail": told(self.detail, translation),
            "instance": instance,
        }
        if request_id:
            document["request_id"] = request_id
        if self.errors:
            document["errors"] = [
                {
                    name: told(value, translation) if isinstance(value, str) else value
                    for name, value in error.items()
                }
                for error in self.errors
            ]
        # In ASCII, because the request may hold characters that cannot be encoded.
        return json.dumps(document).encode("ascii")


def message_of(error: Exception) -> str:
    """Return the message of an error, as a translatable Sentence or as a plain text."""
    message = error.args[0] if error.args else ""
    return message if isinstance(message, str) else str(error)


# Makes the page of a problem; None if a program has made the request.
ProblemPage = Callable[[Request, ProblemError], Response | None]


def too_large() -> ProblemError:
    """Return the error for a request body that is too large."""
    return ProblemError(
        HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
        say("A request may hold {most} KiB; this one is larger.", most=MAX_BODY_SIZE // 1024),
        "body-too-large",
        say("The request is too large"),
        headers={"Connection": "close"},
    )


def store_down(detail: str) -> ProblemError:
    """Return the error for a database that does not respond."""
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        detail,
        STORE_DOWN,
        say("The database cannot be reached now"),
        headers={"Retry-After": "5"},
    )


def failed() -> ProblemError:
    """Return the error for an internal failure of the program."""
    return ProblemError(
        HTTPStatus.INTERNAL_SERVER_ERROR,
        say(
            "The service failed at this request. Nothing is wrong with the answer itself; the "
            "failure has been logged."
        ),
    )


def invalid(
    details: Sequence[Mapping[str, Any]],
    fields: Sequence[str] = (),
    at: tuple[str | int, ...] = (),
) -> ProblemError:
    """Return the error for a request body with faults; ``details`` are pydantic's errors.

    ``fields`` are the names to suggest for an unknown field.
    """
    errors = [
        {
            "pointer": _pointer(detail["loc"]),
            "detail": field_error(detail, fields if detail["loc"][:-1] == at else ()),
        }
        for detail in details[:MAX_ERRORS]
    ]
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        paragraph(
            *(
                say("{place}: {message}", place=error["pointer"], message=error["detail"])
                for error in errors[:3]
            )
        ),
        "invalid-request",
        say("The request does not have the right shape"),
        errors,
    )


def _pointer(location: Sequence[str | int]) -> str:
    steps = (str(step)[:60].replace("~", "~0").replace("/", "~1") for step in location)
    return "#" + "".join(f"/{step}" for step in steps)


def install(app: FastAPI, page: ProblemPage | None = None) -> None:
    """Make the app answer every failure with an error response.

    ``page`` makes the HTML page of an error, for browsers.
    """

    async def answer(request: Request, error: Exception) -> Response:
        problem = _problem(request, error)
        if problem.name == STORE_DOWN:
            _log.warning("The database fails: %s", error.__cause__)
        if request.method == "OPTIONS" and problem.status is HTTPStatus.METHOD_NOT_ALLOWED:
            return Response(status_code=HTTPStatus.NO_CONTENT, headers=problem.headers)
        shown = None if page is None else page(request, problem)
        if shown is not None:
            return shown
        return problem.response(request.url.path, language_of(request))

    for failure in (
        ProblemError,
        HTTPException,
        RequestValidationError,
        ClientDisconnect,
        Exception,
    ):
        app.add_exception_handler(failure, answer)


def _problem(request: Request, error: Exception) -> ProblemError:
    match error:
        case ProblemError():
            return error
        case RequestValidationError():
            return invalid([{**detail, "loc": detail["loc"][1:]} for detail in error.errors()])
        case ClientDisconnect():
            # The client reads no answer, but this must not count as a failure of the service.
            detail = "The request ended before its body was complete."
            return ProblemError(HTTPStatus.BAD_REQUEST, detail)
        case HTTPException(status_code=HTTPStatus.METHOD_NOT_ALLOWED):
            return _other_method(request)
        case HTTPException(status_code=HTTPStatus.REQUEST_ENTITY_TOO_LARGE):
            return too_large()
        case HTTPException(status_code=HTTPStatus.NOT_FOUND, detail=HTTPStatus.NOT_FOUND.phrase):
            detail = say("Nothing is at this address; GET /v1/exercises lists the exercises.")
            return ProblemError(HTTPStatus.NOT_FOUND, detail, headers=error.headers)
        case HTTPException():
            status = HTTPStatus(error.status_code)
            return ProblemError(status, str(error.detail), headers=error.headers)
        case _:  # no details for the client; the server logs the traceback
            return failed()


def _other_method(request: Request) -> ProblemError:
    # The framework names only the methods of one route, and a path may have several.
    path = request.scope["path"].removeprefix(request.scope.get("root_path", ""))
    methods = {
        method
        for route in iter_route_contexts(request.app.router.routes)
        if route.methods and route.path_regex.fullmatch(path)
        for method in route.methods
    }
    methods |= {"HEAD", "OPTIONS"} if "GET" in methods else {"OPTIONS"}
    allow = ", ".join(sorted(methods))
    detail = say(
        "{method} does nothing here; this address takes {allow}.",
        method=request.method[:20],
        allow=allow,
    )
    return ProblemError(HTTPStatus.METHOD_NOT_ALLOWED, detail, headers={"Allow": allow})
