"""Every answer that is not a success: RFC 9457 problem details."""

import json
import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any, Final

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from service.api.http.request_context import current_request
from service.contract.problems import MEDIA_TYPE, TYPE_PREFIX
from service.submissions.strict_json import MAX_BODY_SIZE

MAX_ERRORS = 20
STORE_DOWN: Final = "store-down"

_log = logging.getLogger(__name__)

Detail = Mapping[str, str | int]


@dataclass(eq=False)
class ProblemError(Exception):
    """A request that cannot be answered. ``name`` makes the type; empty for the bare status.

    Each of ``challenges`` is a line ``WWW-Authenticate`` of its own.
    """

    status: HTTPStatus
    detail: str
    name: str = ""
    title: str = ""
    errors: Sequence[Detail] = ()
    headers: Mapping[str, str] | None = None
    challenges: Sequence[str] = ()

    def response(self, instance: str) -> Response:
        """The problem as an answer to a request for the path ``instance``."""
        request = current_request()
        content = self.content(instance, "" if request is None else request.id)
        return self.answer(content, MEDIA_TYPE)

    def answer(self, content: bytes, media_type: str = "text/html") -> Response:
        """The answer with this content, and with the status and headers of the problem."""
        response = Response(content, self.status, self.headers, media_type)
        for challenge in self.challenges:
            response.headers.append("WWW-Authenticate", challenge)
        return response

    def content(self, instance: str, request_id: str = "") -> bytes:
        """The problem as JSON; ``instance`` is what was asked for."""
        document: dict[str, Any] = {
            "type": f"{TYPE_PREFIX}{self.name}" if self.name else "about:blank",
            "title": self.title or self.status.phrase,
            "status": int(self.status),
            "detail": self.detail,
            "instance": instance,
        }
        if request_id:
            document["request_id"] = request_id
        if self.errors:
            document["errors"] = list(self.errors)
        # Escaped to ASCII: whatever the request held can be written out.
        return json.dumps(document).encode("ascii")


# A problem as a page; None for a request that a program has made.
ProblemPage = Callable[[Request, ProblemError], Response | None]


def too_large() -> ProblemError:
    """A body over the limit. The connection ends, so that the rest of it is not read."""
    return ProblemError(
        HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
        f"A request may hold {MAX_BODY_SIZE // 1024} KiB; this one is larger.",
        "body-too-large",
        "The request is too large",
        headers={"Connection": "close"},
    )


def store_down(detail: str) -> ProblemError:
    """The database of the attempts cannot be reached; grading goes on without it."""
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        detail,
        STORE_DOWN,
        "The database cannot be reached now",
        headers={"Retry-After": "5"},
    )


def failed() -> ProblemError:
    """A failure of the program itself."""
    return ProblemError(
        HTTPStatus.INTERNAL_SERVER_ERROR,
        "The service failed at this request. Nothing is wrong with the answer itself; the failure "
        "has been logged.",
    )


def invalid(details: Sequence[Mapping[str, Any]], fields: Sequence[str] = ()) -> ProblemError:
    """The problem for pydantic's findings in a body; ``fields`` are those that a body may have."""
    errors = [
        {"pointer": _pointer(detail["loc"]), "detail": _message(detail, fields)}
        for detail in details[:MAX_ERRORS]
    ]
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        " ".join(f"{error['pointer']}: {error['detail']}" for error in errors[:3]),
        "invalid-request",
        "The request does not have the right shape",
        errors,
    )


# A longer pattern says nothing to a reader: it is that of a line that can be told from all others.
_LONGEST_PATTERN: Final = 200


def _pointer(location: Sequence[str | int]) -> str:
    """A JSON pointer as a URI fragment, as RFC 9457 writes it; overlong keys are cut."""
    steps = (str(step)[:60].replace("~", "~0").replace("/", "~1") for step in location)
    return "#" + "".join(f"/{step}" for step in steps)


def _message(detail: Mapping[str, Any], fields: Sequence[str]) -> str:
    if detail["type"] == "extra_forbidden" and fields:
        return f"This field is not known; the fields are {', '.join(fields)}."
    if detail["type"] == "missing":
        return "This field is missing."
    if detail["type"] in ("model_type", "model_attributes_type"):
        return f"{'This' if detail['loc'] else 'The body'} must be a JSON object."
    if detail["type"] == "too_long" and "ctx" in detail and detail["loc"]:
        most, here = detail["ctx"]["max_length"], detail["ctx"]["actual_length"]
        return f"At most {most} {detail['loc'][-1]} may be sent at once; these are {here}."
    if detail["type"] == "string_pattern_mismatch" and len(detail["msg"]) > _LONGEST_PATTERN:
        return "Write one line of visible characters, with single blanks between words."
    message: str = detail["msg"].removeprefix("Value error, ")
    return message if message.endswith((".", "?")) else f"{message}."


def install(app: FastAPI, page: ProblemPage | None = None) -> None:
    """Have the app answer every failure, its framework's own included, with a problem.

    Whoever reads in a browser gets its ``page``.
    """

    async def answer(request: Request, error: Exception) -> Response:
        problem = _problem(request, error)
        if problem.name == STORE_DOWN:
            _log.warning("The database fails: %s", error.__cause__)
        if request.method == "OPTIONS" and problem.status is HTTPStatus.METHOD_NOT_ALLOWED:
            return Response(status_code=HTTPStatus.NO_CONTENT, headers=problem.headers)
        shown = None if page is None else page(request, problem)
        return problem.response(request.url.path) if shown is None else shown

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
            # The client reads no answer; this only keeps it from counting as our failure.
            detail = "The request ended before its body was complete."
            return ProblemError(HTTPStatus.BAD_REQUEST, detail)
        case HTTPException(status_code=HTTPStatus.METHOD_NOT_ALLOWED):
            return _other_method(request, error)
        case HTTPException(status_code=HTTPStatus.REQUEST_ENTITY_TOO_LARGE):
            return too_large()
        case HTTPException(status_code=HTTPStatus.NOT_FOUND, detail=HTTPStatus.NOT_FOUND.phrase):
            detail = "Nothing is at this address; GET /v1/exercises lists the exercises."
            return ProblemError(HTTPStatus.NOT_FOUND, detail, headers=error.headers)
        case HTTPException():
            status = HTTPStatus(error.status_code)
            return ProblemError(status, str(error.detail), headers=error.headers)
        case _:  # without details; the server logs the traceback
            return failed()


def _other_method(request: Request, error: HTTPException) -> ProblemError:
    """The problem that names the other methods: HEAD goes wherever GET does."""
    methods = set((error.headers or {}).get("Allow", "").replace(" ", "").split(",")) - {""}
    methods |= {"HEAD", "OPTIONS"} if "GET" in methods else {"OPTIONS"}
    allow = ", ".join(sorted(methods))
    detail = f"{request.method[:20]} does nothing here; this address takes {allow}."
    return ProblemError(HTTPStatus.METHOD_NOT_ALLOWED, detail, headers={"Allow": allow})
