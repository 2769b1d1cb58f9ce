"""What all routes share: errors, bodies, exercise ids, languages, turns, threads, and responses.

It knows HTTP, and of exercises only their ids and the ids of their parts. Who may use a route is
in ``permissions.py``, and how a route reaches the database in ``recording.py``.
"""

import asyncio
import json
import logging
import math
import re
import secrets
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Hashable, Iterable, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from email.message import Message
from functools import partial
from http import HTTPStatus
from itertools import islice
from time import perf_counter
from typing import Annotated, Any, Final, NamedTuple, Protocol, TypeVar

from fastapi import Depends, FastAPI, Path, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.routing import iter_route_contexts
from pydantic import BaseModel, StringConstraints, TypeAdapter, ValidationError
from starlette.exceptions import HTTPException
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import ClientDisconnect, HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send

from dh_grader.access import Caller
from dh_grader.catalogue import Exercise
from dh_grader.contract import MEDIA_TYPE, TYPE_PREFIX, general_name
from dh_grader.grading import Report
from dh_grader.regex import regex
from dh_grader.slices import in_slices
from dh_grader.submissions.bodies import (
    MAX_BODY_SIZE,
    MalformedError,
    UnknownExerciseError,
    field_error,
    find_exercise,
    nearest,
    read_json,
)
from dh_grader.translations import (
    ENGLISH,
    Language,
    Sentence,
    accepted_language,
    language_named,
    paragraph,
    say,
    told,
)

# --- Error responses in the format of RFC 9457 (problem details)


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


# --- Read the body of a request and validate it as an instance of a pydantic model

M = TypeVar("M", bound=BaseModel)
# A place in a body: the keys and indices that lead to it.
Location = tuple[str | int, ...]


async def read_body(model: type[M], request: Request) -> M:
    """Return the request's JSON body as an instance of ``model``. Raises ProblemError."""
    # JSON is accepted with any Content-Type, because forms and scripts often omit this header. That
    # is safe: a cookie gives rights only to requests of the service's own pages.
    try:
        value = read_json(await request.body())
    except MalformedError as error:
        raise _malformed(error, request.headers.get("content-type", "")) from error
    return validated(model, value)


def validated(model: type[M], value: object, at: Location = ()) -> M:
    """Return ``value``, a part of a request body, as an instance of ``model``.

    ``at`` is the path of ``value`` in the body. Raises ProblemError.
    """
    try:
        return model.model_validate(_with_few_unknown(model, value))
    except ValidationError as error:
        details = error.errors(include_url=False, include_input=False)
        placed = [{**detail, "loc": (*at, *detail["loc"])} for detail in details]
        raise invalid(placed, list(model.model_fields), at) from error


def _with_few_unknown(model: type[BaseModel], value: object) -> object:
    # An error response lists at most MAX_ERRORS errors, so further unknown fields are removed.
    known = model.model_fields
    if not isinstance(value, dict) or len(value) <= len(known) + MAX_ERRORS:
        return value
    unknown = islice((key for key in value if key not in known), MAX_ERRORS)
    return {key: value[key] for key in (*filter(value.__contains__, known), *unknown)}


def _malformed(error: MalformedError, content_type: str) -> ProblemError:
    if content_type and not _is_json(content_type):
        return ProblemError(
            HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
            say("The body is not JSON; send a JSON object, as application/json."),
        )
    place = {} if error.line is None else {"line": error.line, "column": error.column or 1}
    return ProblemError(
        HTTPStatus.BAD_REQUEST,
        str(error),
        "malformed-json",
        say("The body cannot be read"),
        [{"detail": error.reason, **place}],
    )


def _is_json(content_type: str) -> bool:
    header = Message()
    header["content-type"] = content_type
    return header.get_content_subtype().rpartition("+")[2] == "json"


# --- Find the exercises and the parts of exercises that a request names


Catalogue = Mapping[str, Exercise]
ExerciseId = Annotated[
    str, Path(max_length=200, description="The id of an exercise.", examples=["stanford-arm"])
]
AttemptId = Annotated[str, Path(max_length=100, description="The id of an attempt.")]


def reachable_exercises(catalogue: Catalogue, caller: Caller) -> Catalogue:
    """Return the exercises that the caller may use."""
    return {name: each for name, each in catalogue.items() if caller.reaches(name)}


def exercise_or_404(catalogue: Catalogue, exercise_id: str) -> Exercise:
    """Return the exercise with an id from the URL. Raises ProblemError."""
    try:
        return find_exercise(catalogue, exercise_id)
    except UnknownExerciseError as error:
        raise ProblemError(
            HTTPStatus.NOT_FOUND,
            message_of(error),
            "unknown-exercise",
            say("There is no such exercise"),
        ) from error


def require_exercise(catalogue: Catalogue, exercise_id: str) -> Exercise:
    """Return the exercise with an id from the request body. Raises ProblemError."""
    try:
        return find_exercise(catalogue, exercise_id)
    except UnknownExerciseError as error:
        detail = {"type": "unknown", "loc": ("exercise",), "msg": message_of(error)}
        raise invalid([detail]) from error


def require_exercises(catalogue: Catalogue, exercise_ids: Iterable[str], field: str) -> None:
    """Check that all exercises listed in a request body exist. Raises ProblemError."""
    details = []
    for i, exercise_id in enumerate(exercise_ids):
        try:
            find_exercise(catalogue, exercise_id)
        except UnknownExerciseError as error:
            details.append({"type": "unknown", "loc": (field, i), "msg": message_of(error)})
    if details:
        raise invalid(details)


def require_parts(exercise: Exercise, located: Iterable[tuple[str, Location]]) -> None:
    """Check that the exercise has the parts that a request names. Raises ProblemError.

    ``located`` has pairs: the id of a part, and the path of the id in the request body.
    """
    absent = (each for each in located if exercise.part(each[0]) is None)
    known = [part.id for part in exercise.parts]
    details = []
    for part, place in islice(absent, MAX_ERRORS):
        meant = nearest(part, known)
        message = paragraph(
            say("{exercise} has no such part.", exercise=exercise.id),
            say("Did you mean {suggestion!r}?", suggestion=meant) if meant else "",
            say("Its parts are: {parts}.", parts=", ".join(known)),
        )
        details.append({"type": "unknown", "loc": place, "msg": message})
    if details:
        problem = invalid(details)
        raise replace(problem, name="unknown-part", title=say("The exercise has no such part"))


# --- Optional query parameters that several routes have, in the document and checked alike


@dataclass(frozen=True)
class QueryParameter:
    """An optional query parameter; ``values`` accepts its values."""

    name: str
    description: str
    values: TypeAdapter[str]

    @property
    def documented(self) -> Mapping[str, Any]:
        """The parameter as in the OpenAPI document."""
        return {
            "name": self.name,
            "in": "query",
            "required": False,
            "description": self.description,
            "schema": self.values.json_schema(),
        }

    def check(self, request: Request) -> None:
        """Check the value in a request, if there is one. Raises RequestValidationError."""
        value = request.query_params.get(self.name)
        if value is None:
            return
        try:
            self.values.validate_python(value)
        except ValidationError as error:
            details = error.errors(include_url=False)
            raise RequestValidationError(
                [{**each, "loc": ("query", self.name)} for each in details]
            ) from error


def with_parameters(options: Mapping[str, Any], *parameters: QueryParameter) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that also has these query parameters."""

    async def check(request: Request) -> None:
        for each in parameters:
            each.check(request)

    extra = options.get("openapi_extra", {})
    documented = [*extra.get("parameters", ()), *(each.documented for each in parameters)]
    return {
        **options,
        "openapi_extra": {**extra, "parameters": documented},
        "dependencies": [*options.get("dependencies", ()), Depends(check)],
    }


# --- The language of the reader who sends a request, and of the response


# The field of a query that chooses a language, and the cookie that keeps the choice.
LANGUAGE_FIELD: Final = "lang"
LANGUAGE_COOKIE: Final = "dh_grader_language"
_A_YEAR: Final = 365 * 24 * 3600
_LANGUAGE: Final = QueryParameter(
    LANGUAGE_FIELD,
    "The language of sentences for people: `en`, `de`, `es`, `fr` or `zh`. Default: "
    "`Accept-Language`. A sentence without a translation is in English, and so is an answer in a "
    "language that the service does not have.",
    TypeAdapter(Annotated[str, StringConstraints(max_length=35)]),
)
# Caches keep an answer for each language.
_VARY: Final = {"Vary": "Accept-Language, Cookie"}


def language_of(request: HTTPConnection, usual: str | None = None) -> Language:
    """Return the reader's language: from the query, the cookie, or ``Accept-Language``.

    ``usual`` is a known language of the reader, for example from a learning platform.
    """
    # The first that names a known language decides; the default is English.
    return (
        language_named(request.query_params.get(LANGUAGE_FIELD))
        or language_named(request.cookies.get(LANGUAGE_COOKIE))
        or language_named(usual)
        or accepted_language(request.headers.get("accept-language"))
    )


def keep_language(request: HTTPConnection, response: Response) -> None:
    """Store the language that the query chooses, if any, in a cookie."""
    if chosen := language_named(request.query_params.get(LANGUAGE_FIELD)):
        response.set_cookie(
            LANGUAGE_COOKIE,
            chosen.code,
            max_age=_A_YEAR,
            path=request.scope.get("root_path") or "/",
            secure=request.url.scheme == "https",
            httponly=True,
            samesite="lax",
        )


def in_languages(options: dict[str, Any]) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that also has the query parameter ``lang``."""
    return with_parameters(options, _LANGUAGE)


def language_headers(language: Language) -> dict[str, str]:
    """Return the headers ``Content-Language`` and ``Vary`` of a response in this language."""
    return {"Content-Language": language.tag, **_VARY}


def told_json(
    content: bytes | str,
    language: Language,
    status: HTTPStatus = HTTPStatus.OK,
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Return a JSON response whose headers name its language."""
    named = {**language_headers(language), **(headers or {})}
    return Response(content, status, named, "application/json")


# --- The request that is being answered: its id, its route, and when it arrived


# The header with the id of a request. The id of a client is kept, and sent with the answer.
HEADER: Final = "X-Request-ID"
# Ids as proxies and tracers write them, without characters that a log would have to quote.
_WELL_FORMED: Final = regex(r"[A-Za-z0-9._:=+/-]{1,128}", re.ASCII)


@dataclass(slots=True)
class RequestContext:
    """A request; ``route`` is the pattern of its path, such as ``/v1/exercises/{exercise_id}``."""

    id: str
    route: str = ""
    arrived: float = field(default_factory=perf_counter)

    @property
    def seconds(self) -> float:
        """The seconds since the request arrived."""
        return perf_counter() - self.arrived


_current: ContextVar[RequestContext | None] = ContextVar("request", default=None)


def begin_request(wished: str | None = None) -> RequestContext:
    """Start a new request in the current task; ``wished`` is the id that the client asks for."""
    usable = wished is not None and _WELL_FORMED.fullmatch(wished)
    context = RequestContext(wished if usable and wished else secrets.token_hex(16))
    _current.set(context)
    return context


def current_request() -> RequestContext | None:
    """Return the request that the current task answers, or None."""
    return _current.get()


def end_request() -> None:
    """End the request of the current task."""
    _current.set(None)


# --- Share the processor fairly between the requests of clients


T = TypeVar("T")

# The key of a request's ASGI scope under which a layer leaves the function that awaits a turn.
TURN: Final = "dh_grader.turn"
# The key under which this layer leaves the moment at which it had received the whole request.
ARRIVED: Final = "dh_grader.arrived"
# The key under which an earlier layer leaves the client, unless that is just the address.
CLIENT: Final = "dh_grader.client"


class Client(NamedTuple):
    """The client that sent a request.

    A client with several requests at once gets more processor time: up to ``most_shares`` times as
    much.
    """

    # A course's server or a university's address may have several shares, because it sends the
    # requests of many students.

    name: str
    most_shares: float

    @property
    def is_trusted(self) -> bool:
        """True if the client's part of the processor time has no limit."""
        return self.most_shares == math.inf


# The shares of a student, of an address (a class, or an attacker), and of a course site.
ONE_STUDENT, ONE_ADDRESS, COURSE_SITE = 1.0, 8.0, math.inf


def arrived_at(request: Request) -> datetime:
    """Return the time when the whole request was received."""
    # This time decides whether answers were handed in late.
    found: datetime | None = request.scope.get(ARRIVED)
    return found or datetime.now(UTC)


async def give_way(request: Request) -> None:
    """Let other requests run, and wait until this request may continue.

    Raises ClientDisconnect.
    """
    turn: Callable[[], Awaitable[None]] | None = request.scope.get(TURN)
    # Without such a layer, as in tests of routes: let every other ready task run once.
    await (asyncio.sleep(0) if turn is None else turn())


async def run_in_turns(request: Request, work: Callable[[], T]) -> T:
    """Call ``work`` and return its result; let other requests run meanwhile.

    Raises ClientDisconnect.
    """
    return await in_slices(work, partial(give_way, request))


# --- Do slow work in a thread, one task at a time, with a short queue or memoized


# The length of the queue. A tutor's page waits for an answer before its next request.
WAITING: Final = 4
# A course has a few dozen exercises. A solution or figure takes about ten kilobytes.
MOST_RESULTS: Final = 128


class BoundedWork:
    """Does one task at a time in a thread; refuses further tasks if the queue is full."""

    def __init__(self) -> None:
        self._working = asyncio.Lock()
        self._accepted = 0

    async def do(self, work: Callable[[], T]) -> T:
        """Do ``work`` and return its result. Raises ProblemError if the queue is full."""
        if self._accepted > WAITING:
            raise ProblemError(
                HTTPStatus.SERVICE_UNAVAILABLE,
                "Other work waits already. Try again in a few seconds.",
                "busy",
                "The service has a lot to do",
                headers={"Retry-After": "5"},
            )
        self._accepted += 1
        try:
            async with self._working:
                return await asyncio.to_thread(work)
        finally:
            self._accepted -= 1


class MemoizedResults:
    """Keeps the most recently used results in memory."""

    def __init__(self) -> None:
        self._results: OrderedDict[Hashable, bytes] = OrderedDict()
        self._lock = asyncio.Lock()

    async def of(self, key: Hashable, work: Callable[[], bytes]) -> bytes:
        """Return the result for this key; call ``work`` if the result is not in memory."""
        if key not in self._results:
            async with self._lock:
                if key not in self._results:
                    self._results[key] = await asyncio.to_thread(work)
                    while len(self._results) > MOST_RESULTS:
                        self._results.popitem(last=False)
        self._results.move_to_end(key)
        return self._results[key]


# --- Responses that no cache stores, that are sent in chunks, or that are compressed

NO_STORE: Final = {"Cache-Control": "no-store"}
# Bytes of a chunk.
_CHUNK: Final = 16 * 1024
# Of nine levels. Higher ones take twice as long and save 1 %.
_GZIP_LEVEL: Final = 6


def private(model: BaseModel, status: HTTPStatus = HTTPStatus.OK) -> Response:
    """Return the model as a JSON response that no cache may store."""
    return private_json(model.model_dump_json(exclude_none=True), status)


def private_json(content: bytes | str, status: HTTPStatus = HTTPStatus.OK) -> Response:
    """Return JSON as a response that no cache may store."""
    return Response(content, status, NO_STORE, "application/json")


class ChunkedResponse(Response):
    """A response that is sent in chunks; at most one chunk is buffered."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:  # noqa: ARG002
        """Serve one ASGI connection."""
        start = {"status": self.status_code, "headers": self.raw_headers}
        await send({"type": "http.response.start", **start})
        for i in range(0, max(1, len(self.body)), _CHUNK):
            piece, more = self.body[i : i + _CHUNK], i + _CHUNK < len(self.body)
            await send({"type": "http.response.body", "body": piece, "more_body": more})


class CompressedGets:
    """Compress the responses to GET for clients that accept gzip."""

    # The responses to POST are small and must be fast, so they are not compressed.

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self._packed = GZipMiddleware(app, compresslevel=_GZIP_LEVEL)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        is_get = scope["type"] == "http" and scope["method"] == "GET"
        await (self._packed if is_get else self.app)(scope, receive, send)


# --- The interface through which the application counts requests and reports in the metrics


class Monitor(Protocol):
    """Counts requests and reports, without changing any response."""

    def watched(self, app: ASGIApp) -> ASGIApp:
        """Return the application, wrapped in a layer that counts requests."""

    def graded(self, report: Report, seconds: float) -> None:
        """Count a report, and record how many seconds the grading took."""

    def refused(self, answer: str) -> None:
        """Count a refused request; ``answer`` is the status code of the response, or "none"."""
