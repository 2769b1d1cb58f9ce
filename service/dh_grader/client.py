"""A typed client of the service, with and without ``await``, and its exceptions.

GraderClientError         a call failed
├── RequestRefusedError     the service answered with an error
├── ServerUnreachableError  there was no complete response
└── UnexpectedAnswerError   the response is not from a DH Grader

It loads httpx, so the program imports it only where it is needed. How submissions in files are sent
is in ``cli/remote_grading.py``.
"""

import asyncio
import json
import random
import ssl
import threading
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from email.utils import parsedate_to_datetime
from functools import wraps
from http import HTTPStatus
from socket import EAI_NONAME, gaierror
from typing import Any, Final, Generic, ParamSpec, Self, TypeVar, overload
from urllib.parse import quote, urlencode
from uuid import uuid4

import httpx
from pydantic import BaseModel, TypeAdapter, ValidationError

from dh_grader import VERSION
from dh_grader.catalogue import FeedbackLevel
from dh_grader.contract import (
    TYPE_PREFIX,
    AttemptResponse,
    ExerciseList,
    ExerciseSummary,
    ExerciseView,
    GradeManyResponse,
    GradeResult,
    Hint,
    HintRequest,
    PracticeRobot,
    ProblemDocument,
    Reason,
    RegradeAnswer,
    RegradeRequest,
)
from dh_grader.contract.courses import (
    AddedLearners,
    AssignmentChange,
    Course,
    CourseAssignment,
    CourseAssignmentList,
    CourseChange,
    CourseList,
    DealRequest,
    DeletedData,
    DeletionRequest,
    Extension,
    Gradebook,
    GradebookFormat,
    HandInRequest,
    LearnerList,
    LearnersRequest,
    LearnerVariant,
    LearnerVariants,
    LinkList,
    LinksRequest,
    MissingList,
    NewAssignment,
    NewCourse,
    OwnCourses,
    PlatformScores,
    RemovalRequest,
    RevokedLinks,
    RevokeLinksRequest,
    SendAgainRequest,
    SentAgain,
)
from dh_grader.contract.frames import PreviewAnswer, PreviewRequest
from dh_grader.expressions import AngleUnit, Kind
from dh_grader.formats.documents import read_report
from dh_grader.grading import Report
from dh_grader.kinematics import Convention
from dh_grader.regex import regex
from dh_grader.solutions import ModelSolution
from dh_grader.submissions.bodies import (
    MAX_BODY_SIZE,
    MAX_BRACKETS,
    MAX_COMMAS,
    MAX_SUBMISSIONS,
    ExerciseSubmission,
    GradeRequest,
)
from dh_grader.translations import say

__all__ = [
    "AsyncGraderClient",
    "ExerciseSubmission",
    "ExerciseSummary",
    "ExerciseView",
    "FeedbackLevel",
    "GradeResult",
    "GraderClient",
    "GraderClientError",
    "PreviewAnswer",
    "Report",
    "RequestRefusedError",
    "Retries",
    "ServerUnreachableError",
    "UnexpectedAnswerError",
]


# --- The exceptions of the client


# The service is overloaded, or it restarts behind a proxy.
_TEMPORARY: Final = {
    HTTPStatus.TOO_MANY_REQUESTS,
    HTTPStatus.BAD_GATEWAY,
    HTTPStatus.SERVICE_UNAVAILABLE,
    HTTPStatus.GATEWAY_TIMEOUT,
}


class GraderClientError(Exception):
    """A call failed; the message says why.

    If ``is_temporary``, the call may succeed after ``retry_after`` seconds.
    """

    def __init__(
        self, message: str, *, is_temporary: bool = False, retry_after: float = 0.0
    ) -> None:
        super().__init__(message)
        self.is_temporary = is_temporary
        self.retry_after = retry_after


class RequestRefusedError(GraderClientError):
    """The service answered with an error.

    ``status`` is the HTTP status, ``code`` the name of the error, such as ``unknown-exercise``.
    ``reasons`` describes each fault of the request.
    """

    def __init__(
        self,
        status: int,
        message: str,
        *,
        name: str = "",
        reasons: tuple[Reason, ...] = (),
        retry_after: float = 0.0,
    ) -> None:
        super().__init__(message, is_temporary=status in _TEMPORARY, retry_after=retry_after)
        self.status = status
        self.code = name
        self.message = message
        self.reasons = reasons


class ServerUnreachableError(GraderClientError):
    """There was no response, or the response was incomplete."""


class UnexpectedAnswerError(GraderClientError):
    """The response is not from a DH Grader of this version.

    A redirect also raises this error: a client that follows a redirect may reveal its key.
    """


# --- The rules by which failed calls are retried


@dataclass(frozen=True, slots=True)
class Retries:
    """The number of retries, and the waits before them in seconds.

    The waits double from ``first_wait`` up to ``longest_wait``.
    """

    # By default, the waits last 15 seconds in all, so that a service can restart meanwhile. Each
    # wait is shortened at random by up to half, so that clients that failed together do not retry
    # together. A wait that the service asks for is added; if it is longer than
    # ``longest_wait``, the client gives up.

    number: int = 5
    first_wait: float = 0.5
    longest_wait: float = 30.0

    def wait(self, failures: int, error: GraderClientError) -> float | None:
        """Return the seconds to wait after this number of failures, or None to give up.

        Only temporary failures are retried: no response, or the status 429, 502, 503 or 504.
        """
        if failures > self.number or not error.is_temporary:
            return None
        if error.retry_after > self.longest_wait:
            return None
        longest = min(self.first_wait * 2.0 ** (failures - 1), self.longest_wait)
        return error.retry_after + random.uniform(longest / 2, longest)


# --- Receive the responses of a server within limits, and convert failures to exceptions


# Far larger than the reports on the most submissions in one request (bytes).
MAX_ANSWER: Final = 64 * 1024 * 1024


@dataclass(frozen=True, slots=True)
class HttpAnswer:
    """A complete response."""

    status: int
    headers: httpx.Headers
    content: bytes


@dataclass
class AnswerPieces:
    """Collects the pieces of a response; ``seconds`` is the time limit for the whole response."""

    # The time limits of httpx apply to each piece. A server that sends a byte now and then would
    # never exceed them.

    response: httpx.Response
    seconds: float
    _content: bytearray = field(default_factory=bytearray)
    _began: float = field(default_factory=time.monotonic)

    def add(self, piece: bytes) -> None:
        """Add a piece. Raises httpx.ReadTimeout or UnexpectedAnswerError."""
        self._content += piece
        if len(self._content) > MAX_ANSWER:
            raise UnexpectedAnswerError(
                say(
                    "The answer has more than {most} MiB; no report is so large.",
                    most=MAX_ANSWER // 1024**2,
                )
            )
        if time.monotonic() - self._began > self.seconds:
            raise httpx.ReadTimeout(f"no complete answer within {self.seconds:g} seconds")

    def whole(self) -> HttpAnswer:
        """Return the complete response, after the last piece."""
        return HttpAnswer(self.response.status_code, self.response.headers, bytes(self._content))


def unreachable(server: str, error: httpx.TransportError) -> ServerUnreachableError:
    """Convert a connection error of httpx to an exception of this client."""
    reason = str(error) or type(error).__name__
    message = say("{server} cannot be reached: {reason}", server=server, reason=reason)
    is_temporary = not any(map(_is_permanent, _causes(error)))
    return ServerUnreachableError(message, is_temporary=is_temporary)


def error_in(server: str, answer: HttpAnswer) -> GraderClientError:
    """Return the exception for an error response."""
    if location := answer.headers.get("location"):
        return UnexpectedAnswerError(
            say(
                "{server} redirects to {location}; if you trust that address, call it instead.",
                server=server,
                location=location,
            )
        )
    wait = _seconds(answer.headers.get("retry-after", ""))
    try:
        problem = ProblemDocument.model_validate_json(answer.content)
    except ValidationError:
        # Perhaps the answer of a proxy: its page for people is useless to a program.
        message = say(
            "{server} answers with the status {status}.", server=server, status=answer.status
        )
        return RequestRefusedError(answer.status, message, retry_after=wait)
    name = problem.type.removeprefix(TYPE_PREFIX) if problem.type.startswith(TYPE_PREFIX) else ""
    reasons = tuple(problem.errors or ())
    return RequestRefusedError(
        answer.status, problem.detail, name=name, reasons=reasons, retry_after=wait
    )


def _seconds(retry_after: str) -> float:
    if retry_after.isascii() and retry_after.isdigit():
        return float(retry_after[:9])
    try:
        date = parsedate_to_datetime(retry_after)
    except (ValueError, TypeError):
        return 0.0
    return max(0.0, date.timestamp() - time.time())


def _is_permanent(cause: BaseException) -> bool:
    if isinstance(cause, gaierror):
        return cause.errno == EAI_NONAME
    return isinstance(cause, ssl.SSLCertVerificationError)


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__


# --- The calls of the service: build requests, and read responses
#
# The clients make their methods from these functions.


T = TypeVar("T")


def _new_key() -> str:
    return str(uuid4())


@dataclass(frozen=True, slots=True)
class HttpCall(Generic[T]):
    """One call: POST if it has a body, otherwise GET. ``read`` parses the response.

    Retries have the same ``idempotency_key``, by which the service recognizes them.
    """

    path: str
    read: Callable[[bytes], T]
    body: bytes | None = None
    idempotency_key: str = field(default_factory=_new_key)

    @property
    def method(self) -> str:
        """The HTTP method."""
        return "GET" if self.body is None else "POST"

    @property
    def headers(self) -> Mapping[str, str]:
        """The headers of this call."""
        if self.body is None:
            return {}
        return {"Content-Type": "application/json", "Idempotency-Key": self.idempotency_key}

    def result(self, server: str, answer: HttpAnswer) -> T:
        """Parse the response; return the result. Raises GraderClientError."""
        if answer.status not in (200, 201):
            raise error_in(server, answer)
        try:
            return self.read(answer.content)
        except ValidationError as error:
            raise UnexpectedAnswerError(
                say(
                    "The answer of {server} is not that of a DH Grader of this version.",
                    server=server,
                )
            ) from error


def exercises() -> HttpCall[list[ExerciseSummary]]:
    """Return the exercises of the service."""
    return HttpCall("v1/exercises", _exercises)


def exercise(exercise: str) -> HttpCall[ExerciseView]:
    """Return the exercise with this id as students see it."""
    return HttpCall(_exercise_path(exercise), ExerciseView.model_validate_json)


def next_robot(
    level: int = 1, convention: Convention = Convention.STANDARD, after: str | None = None
) -> HttpCall[PracticeRobot]:
    """Return a generated robot to practise with; ``after`` is the id of the previous robot."""
    query = _query(level=str(level), convention=convention.value, after=after)
    return HttpCall(f"v1/practice/next{query}", PracticeRobot.model_validate_json)


def grade(
    exercise: str,
    answers: Mapping[str, Any],
    *,
    angle_unit: AngleUnit = "radians",
    feedback: FeedbackLevel | None = None,
    echo: bool = False,
    idempotency_key: str | None = None,
) -> HttpCall[Report]:
    """Grade answers, which are given by part id; return the report.

    Calls with the same ``idempotency_key`` count as one submission. Raises
    pydantic.ValidationError.
    """
    fields = {"answers": dict(answers), "angle_unit": angle_unit, "feedback": feedback}
    body = encoded(GradeRequest.model_validate(fields | {"echo": echo}))
    return HttpCall(
        f"{_exercise_path(exercise)}/grade", read_report, body, idempotency_key or _new_key()
    )


def hint(
    exercise: str,
    answers: Mapping[str, Any],
    part: str,
    code: str,
    step: int = 1,
    *,
    row: str | None = None,
    cell: str | None = None,
    angle_unit: AngleUnit = "radians",
) -> HttpCall[Hint]:
    """Return a step of the hint for the message ``code`` in the report on these answers.

    ``row`` and ``cell`` say where the message is. Raises pydantic.ValidationError.
    """
    fields = {"answers": dict(answers), "angle_unit": angle_unit, "part": part, "code": code}
    place = {"row": row, "cell": cell, "step": step}
    body = encoded(HintRequest.model_validate(fields | place))
    return HttpCall(f"{_exercise_path(exercise)}/hints", Hint.model_validate_json, body)


def preview(
    text: str,
    *,
    exercise: str | None = None,
    part: str | None = None,
    angle_unit: AngleUnit = "radians",
    quantity: Kind = "number",
) -> HttpCall[PreviewAnswer]:
    """Return how the service reads a text, or why it cannot read it."""
    request = PreviewRequest(
        text=text, exercise=exercise, part=part, angle_unit=angle_unit, quantity=quantity
    )
    return HttpCall("v1/preview", PreviewAnswer.model_validate_json, encoded(request))


def grade_many(
    submissions: Iterable[ExerciseSubmission],
) -> Iterator[HttpCall[list[GradeResult]]]:
    """Yield as few calls as possible to grade all submissions."""
    waiting: list[bytes] = []
    for content in map(encoded, submissions):
        if waiting and not _fits([*waiting, content]):
            yield HttpCall("v1/grade", _results, _together(waiting))
            waiting = []
        waiting.append(content)
    if waiting:
        yield HttpCall("v1/grade", _results, _together(waiting))


def encoded(body: BaseModel) -> bytes:
    """Return the body as JSON, without fields with default values."""
    # Python's own encoder sends a NaN in an answer as such, and the service explains it.
    content = body.model_dump(exclude_defaults=True)
    try:
        return json.dumps(content, ensure_ascii=False, separators=(",", ":")).encode()
    except UnicodeEncodeError:  # a lone surrogate, which can only be sent escaped
        return json.dumps(content, separators=(",", ":")).encode()


def _exercise_path(exercise: str) -> str:
    return "v1/exercises/" + quote(exercise, safe="").replace(".", "%2E")


def _query(**given: str | None) -> str:
    query = urlencode({name: value for name, value in given.items() if value is not None})
    return f"?{query}" if query else ""


def _together(submissions: list[bytes]) -> bytes:
    return b'{"submissions":[%b]}' % b",".join(submissions)


def _fits(submissions: list[bytes]) -> bool:
    body = _together(submissions)
    return (
        len(submissions) <= MAX_SUBMISSIONS
        and len(body) <= MAX_BODY_SIZE
        and body.count(b"[") + body.count(b"{") <= MAX_BRACKETS
        and body.count(b",") <= MAX_COMMAS
    )


def _exercises(content: bytes) -> list[ExerciseSummary]:
    return ExerciseList.model_validate_json(content).exercises


def _results(content: bytes) -> list[GradeResult]:
    return GradeManyResponse.model_validate_json(content).results


# --- The calls of the service for courses


M = TypeVar("M", bound=BaseModel)


def courses() -> HttpCall[CourseList]:
    """Return the courses that the key may see."""
    return HttpCall("v1/courses", CourseList.model_validate_json)


def create_course(new: NewCourse) -> HttpCall[Course]:
    """Create a course."""
    return _sending("v1/courses", new, Course)


def course(course_id: str) -> HttpCall[Course]:
    """Return a course."""
    return HttpCall(_course_path(course_id), Course.model_validate_json)


def change_course(course: str, change: CourseChange) -> HttpCall[Course]:
    """Change the title or the time zone of a course."""
    return _sending(_course_path(course), change, Course)


def delete_course(course: str, wanted: DeletionRequest) -> HttpCall[DeletedData]:
    """Delete a course; without ``apply``, only return what would be deleted."""
    return _sending(_course_path(course, "delete"), wanted, DeletedData)


def delete_assignment(
    course: str, assignment: str, wanted: DeletionRequest
) -> HttpCall[DeletedData]:
    """Delete an assignment; without ``apply``, only return what would be deleted."""
    return _sending(_course_path(course, "assignments", assignment, "delete"), wanted, DeletedData)


def remove_learner(course: str, wanted: RemovalRequest) -> HttpCall[DeletedData]:
    """Remove a learner; without ``apply``, only return what would be deleted."""
    return _sending(_course_path(course, "learners", "remove"), wanted, DeletedData)


def learners(course: str) -> HttpCall[LearnerList]:
    """Return the learners of a course."""
    return HttpCall(_course_path(course, "learners"), LearnerList.model_validate_json)


def add_learners(course: str, new: LearnersRequest) -> HttpCall[AddedLearners]:
    """Add learners, or a class list in CSV; return all learners of the course."""
    return _sending(_course_path(course, "learners"), new, AddedLearners)


def links(course: str, wanted: LinksRequest) -> HttpCall[LinkList]:
    """Return the personal links of learners, and make missing ones."""
    return _sending(_course_path(course, "links"), wanted, LinkList)


def revoke_links(course: str, wanted: RevokeLinksRequest) -> HttpCall[RevokedLinks]:
    """Revoke personal links."""
    return _sending(_course_path(course, "links", "revoke"), wanted, RevokedLinks)


def assignments(course: str) -> HttpCall[CourseAssignmentList]:
    """Return the assignments of a course."""
    return HttpCall(_course_path(course, "assignments"), CourseAssignmentList.model_validate_json)


def assignment(course: str, assignment_id: str) -> HttpCall[CourseAssignment]:
    """Return an assignment with its extensions."""
    path = _course_path(course, "assignments", assignment_id)
    return HttpCall(path, CourseAssignment.model_validate_json)


def create_assignment(course: str, new: NewAssignment) -> HttpCall[CourseAssignment]:
    """Add an assignment to a course."""
    return _sending(_course_path(course, "assignments"), new, CourseAssignment)


def change_assignment(
    course: str, assignment: str, change: AssignmentChange
) -> HttpCall[CourseAssignment]:
    """Change the given fields of an assignment; None removes a date or a limit."""
    return _sending(_course_path(course, "assignments", assignment), change, CourseAssignment)


def extend(course: str, assignment: str, extension: Extension) -> HttpCall[CourseAssignment]:
    """Change the dates or the limit of attempts of an assignment for one learner."""
    path = _course_path(course, "assignments", assignment, "extensions")
    return _sending(path, extension, CourseAssignment)


def variants(course: str, assignment: str, learner: str) -> HttpCall[LearnerVariants]:
    """Return a learner's variants of the exercises in an assignment."""
    path = _course_path(course, "assignments", assignment, "variants") + _query(learner=learner)
    return HttpCall(path, LearnerVariants.model_validate_json)


def deal_variant(course: str, assignment: str, wanted: DealRequest) -> HttpCall[LearnerVariant]:
    """Replace a learner's variant of an exercise by a new variant."""
    return _sending(
        _course_path(course, "assignments", assignment, "variants"), wanted, LearnerVariant
    )


def missing(course: str, assignment: str) -> HttpCall[MissingList]:
    """Return the learners who have not handed in all exercises of an assignment."""
    path = _course_path(course, "assignments", assignment, "missing")
    return HttpCall(path, MissingList.model_validate_json)


def scores(
    course: str,
    assignment: str | None = None,
    learner: str | None = None,
    *,
    failed: bool = False,
) -> HttpCall[PlatformScores]:
    """Return the scores that go to learning platforms."""
    given = {"assignment": assignment, "learner": learner, "failed": "true" if failed else None}
    query = urlencode({name: value for name, value in given.items() if value is not None})
    return HttpCall(f"{_course_path(course, 'scores')}?{query}", PlatformScores.model_validate_json)


def send_scores(course: str, wanted: SendAgainRequest) -> HttpCall[SentAgain]:
    """Send scores to learning platforms again."""
    return _sending(_course_path(course, "scores", "send"), wanted, SentAgain)


def gradebook(course: str, assignment: str | None = None) -> HttpCall[Gradebook]:
    """Return the gradebook of a course, or of one ``assignment``."""
    path = _course_path(course, "gradebook") + _query(assignment=assignment)
    return HttpCall(path, Gradebook.model_validate_json)


def gradebook_file(
    course: str, form: GradebookFormat, assignment: str | None = None
) -> HttpCall[bytes]:
    """Return the gradebook as a file: ``csv``, ``moodle``, ``canvas`` or ``xlsx``."""
    path = _course_path(course, "gradebook") + _query(assignment=assignment, format=form)
    return HttpCall(path, bytes)


def learner_view(course: str, learner: str) -> HttpCall[OwnCourses]:
    """Return a course as one of its learners sees it."""
    return HttpCall(
        _course_path(course, "learners", learner, "view"), OwnCourses.model_validate_json
    )


def assigned_solution(course: str, assignment: str, exercise: str) -> HttpCall[ModelSolution]:
    """Return the solution of an exercise; the client's key must be a learner's link or token."""
    path = _course_path(course, "assignments", assignment, "solutions", exercise)
    return HttpCall(path, _solution)


def regrade(
    exercise: str,
    *,
    course: str | None = None,
    apply: bool = False,
    force: bool = False,
    cursor: str | None = None,
) -> HttpCall[RegradeAnswer]:
    """Regrade some attempts at an exercise.

    Repeat the call with ``next`` of the result as ``cursor``, until ``next`` is None.
    """
    body = RegradeRequest(apply=apply, force=force, cursor=cursor)
    path = f"v1/exercises/{quote(exercise, safe='')}/regrade{_query(course=course)}"
    return _sending(path, body, RegradeAnswer)


def hand_in(
    course: str,
    assignment: str,
    exercise: str,
    answers: Mapping[str, Any],
    *,
    learner: str | None = None,
    idempotency_key: str | None = None,
) -> HttpCall[AttemptResponse]:
    """Hand in answers; return the attempt and its report.

    Calls with the same ``idempotency_key`` are one attempt.
    """
    given = {"exercise": exercise, "answers": dict(answers), "learner": learner}
    body = HandInRequest.model_validate(
        {name: value for name, value in given.items() if value is not None}
    )
    call = _sending(
        _course_path(course, "assignments", assignment, "attempts"), body, AttemptResponse
    )
    return call if idempotency_key is None else replace(call, idempotency_key=idempotency_key)


def own_courses() -> HttpCall[OwnCourses]:
    """Return the learner's courses; the client's key must be a learner's link or token."""
    return HttpCall("v1/me", OwnCourses.model_validate_json)


_solution = TypeAdapter(ModelSolution).validate_json


def _course_path(course: str, *rest: str) -> str:
    names = (quote(each, safe="").replace(".", "%2E") for each in (course, *rest))
    return "/".join(("v1/courses", *names))


def _sending(path: str, body: BaseModel, model: type[M]) -> HttpCall[M]:
    read: Callable[[bytes], M] = model.model_validate_json
    return HttpCall(path, read, body.model_dump_json(exclude_unset=True).encode())


# --- Check the address of a server, and make the options of an httpx client


# The characters of a token of ``Authorization: Bearer`` (RFC 6750).
_KEY: Final = regex(r"[A-Za-z0-9._~+/-]+=*")


def checked_server(server: str) -> str:
    """Return the address of a server without a trailing slash.

    Raises ValueError for an invalid address, such as one with a password, which messages would
    show.
    """
    try:
        url = httpx.URL(server)
    except httpx.InvalidURL as error:
        raise ValueError(
            say(
                "{server!r} is not the address of a server: {reason}",
                server=server,
                reason=str(error),
            )
        ) from error
    if url.scheme not in ("http", "https") or not url.host or server.split() != [server]:
        raise ValueError(
            say(
                "{server!r} is not the address of a server; write https://grader.example.edu",
                server=server,
            )
        )
    if url.userinfo or url.query or url.fragment:
        raise ValueError(say("The address of a server has only scheme, host, port and path."))
    return str(url).rstrip("/")


def client_options(
    server: str, key: str | None, timeout: float, language: str | None = None
) -> dict[str, Any]:
    """Return the options of an httpx client for a checked server.

    Raises ValueError for a key with invalid characters; the message does not show the key.
    """
    # No compression, so that the size of an answer is limited by the bytes received.
    headers = {"User-Agent": f"dh-grader/{VERSION}", "Accept-Encoding": "identity"}
    if language is not None:
        headers["Accept-Language"] = language
    if key is not None:
        if not _KEY.fullmatch(key):
            raise ValueError(
                say("The key is empty or has a character that no key has; copy it again.")
            )
        headers["Authorization"] = f"Bearer {key}"
    return {
        "base_url": server,
        "headers": headers,
        "timeout": timeout,
        "follow_redirects": False,
    }


# --- The clients, with and without ``await``
#
# Their methods build and send the service's calls.


P = ParamSpec("P")


class _Method(Generic[P, T]):
    def __init__(self, call: Callable[P, HttpCall[T]]) -> None:
        self._call = call

    @overload
    def __get__(self, client: None, owner: type) -> Callable[P, HttpCall[T]]: ...

    @overload
    def __get__(self, client: "GraderClient", owner: type) -> Callable[P, T]: ...

    @overload
    def __get__(
        self, client: "AsyncGraderClient", owner: type
    ) -> Callable[P, Coroutine[Any, Any, T]]: ...

    def __get__(self, client: "GraderClient | AsyncGraderClient | None", owner: type) -> Any:
        # Only ``help()`` reads it from the class: it shows the arguments and the docstring.
        return self._call if client is None else client._sending(self._call)


class _Methods:
    exercises = _Method(exercises)
    exercise = _Method(exercise)
    next_robot = _Method(next_robot)
    grade = _Method(grade)
    hint = _Method(hint)
    preview = _Method(preview)
    courses = _Method(courses)
    create_course = _Method(create_course)
    learners = _Method(learners)
    add_learners = _Method(add_learners)
    links = _Method(links)
    revoke_links = _Method(revoke_links)
    assignments = _Method(assignments)
    create_assignment = _Method(create_assignment)
    change_assignment = _Method(change_assignment)
    extend = _Method(extend)
    variants = _Method(variants)
    deal_variant = _Method(deal_variant)
    missing = _Method(missing)
    scores = _Method(scores)
    send_scores = _Method(send_scores)
    gradebook = _Method(gradebook)
    hand_in = _Method(hand_in)
    own_courses = _Method(own_courses)
    course = _Method(course)
    change_course = _Method(change_course)
    delete_course = _Method(delete_course)
    remove_learner = _Method(remove_learner)
    assignment = _Method(assignment)
    delete_assignment = _Method(delete_assignment)
    gradebook_file = _Method(gradebook_file)
    learner_view = _Method(learner_view)
    assigned_solution = _Method(assigned_solution)
    regrade = _Method(regrade)


class GraderClient(_Methods):
    """Calls a DH Grader; several threads may use the same client.

    Every method raises GraderClientError. ``server`` is the address of the service. ``timeout`` is
    in seconds, for one response. ``transport`` is an httpx transport, for your own certificates or
    proxies. Raises ValueError for an invalid address or key.
    """

    def __init__(
        self,
        server: str,
        key: str | None = None,
        *,
        timeout: float = 60.0,
        retries: Retries = Retries(),
        transport: httpx.BaseTransport | None = None,
        language: str | None = None,
    ) -> None:
        self.server = checked_server(server)
        self._timeout = timeout
        self._retries = retries
        self._is_closed = threading.Event()
        options = client_options(self.server, key, timeout, language)
        self._http = httpx.Client(transport=transport, **options)

    def grade_many(self, submissions: Iterable[ExerciseSubmission]) -> Iterator[GradeResult]:
        """Grade submissions in as few requests as possible; yield a report or error for each."""
        for call in grade_many(submissions):
            yield from self._result(call)

    def close(self) -> None:
        """Close the connections and stop all retries."""
        self._is_closed.set()
        self._http.close()

    def __enter__(self) -> Self:
        self._http.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _sending(self, call: Callable[P, HttpCall[T]]) -> Callable[P, T]:
        @wraps(call)
        def send(*args: P.args, **kwargs: P.kwargs) -> T:
            return self._result(call(*args, **kwargs))

        return send

    def _result(self, call: HttpCall[T]) -> T:
        failures = 0
        while True:
            try:
                return call.result(self.server, self._answer(call))
            except GraderClientError as error:
                failures += 1
                wait = self._retries.wait(failures, error)
                # Closing the client ends the waits of other threads.
                if wait is None or self._is_closed.wait(wait):
                    raise

    def _answer(self, call: HttpCall[Any]) -> HttpAnswer:
        try:
            with self._http.stream(
                call.method, call.path, content=call.body, headers=call.headers
            ) as response:
                pieces = AnswerPieces(response, self._timeout)
                for piece in response.iter_raw():
                    pieces.add(piece)
                return pieces.whole()
        except httpx.TransportError as error:
            raise unreachable(self.server, error) from error


class AsyncGraderClient(_Methods):
    """The client for asyncio, with the options of GraderClient; tasks may use the same client."""

    def __init__(
        self,
        server: str,
        key: str | None = None,
        *,
        timeout: float = 60.0,
        retries: Retries = Retries(),
        transport: httpx.AsyncBaseTransport | None = None,
        language: str | None = None,
    ) -> None:
        self.server = checked_server(server)
        self._timeout = timeout
        self._retries = retries
        options = client_options(self.server, key, timeout, language)
        self._http = httpx.AsyncClient(transport=transport, **options)

    async def grade_many(
        self, submissions: Iterable[ExerciseSubmission]
    ) -> AsyncIterator[GradeResult]:
        """Grade submissions in as few requests as possible; yield a report or error for each."""
        for call in grade_many(submissions):
            for result in await self._result(call):
                yield result

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def __aenter__(self) -> Self:
        await self._http.__aenter__()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    def _sending(self, call: Callable[P, HttpCall[T]]) -> Callable[P, Coroutine[Any, Any, T]]:
        @wraps(call)
        async def send(*args: P.args, **kwargs: P.kwargs) -> T:
            return await self._result(call(*args, **kwargs))

        return send

    async def _result(self, call: HttpCall[T]) -> T:
        failures = 0
        while True:
            try:
                return call.result(self.server, await self._answer(call))
            except GraderClientError as error:
                failures += 1
                wait = self._retries.wait(failures, error)
                if wait is None:
                    raise
            await asyncio.sleep(wait)

    async def _answer(self, call: HttpCall[Any]) -> HttpAnswer:
        try:
            async with self._http.stream(
                call.method, call.path, content=call.body, headers=call.headers
            ) as response:
                pieces = AnswerPieces(response, self._timeout)
                async for piece in response.aiter_raw():
                    pieces.add(piece)
                return pieces.whole()
        except httpx.TransportError as error:
            raise unreachable(self.server, error) from error
