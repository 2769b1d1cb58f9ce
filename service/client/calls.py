"""The calls of the service: build requests, and read responses."""

# The clients make their methods from these functions.

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar
from urllib.parse import quote, urlencode
from uuid import uuid4

from pydantic import BaseModel, ValidationError

from service.catalogue import FeedbackLevel
from service.client.answers import HttpAnswer, error_in
from service.client.errors import UnexpectedAnswerError
from service.contract.exercises import (
    ExerciseList,
    ExerciseSummary,
    ExerciseView,
    PracticeRobot,
)
from service.contract.grading import GradeManyResponse, GradeResult, Hint, HintRequest
from service.contract.preview import PreviewAnswer, PreviewRequest
from service.expressions import AngleUnit, Kind
from service.formats.documents.json import read_report
from service.grading import Report
from service.kinematics.dh import Convention
from service.submissions.body import MAX_SUBMISSIONS, ExerciseSubmission, GradeRequest
from service.submissions.strict_json import MAX_BODY_SIZE, MAX_BRACKETS, MAX_COMMAS
from service.translations import say

T = TypeVar("T")


def _new_key() -> str:
    return str(uuid4())


@dataclass(frozen=True, slots=True)
class HttpCall(Generic[T]):
    """One call: POST if it has a body, otherwise GET. ``read`` parses the response."""

    # Retries have the same ``idempotency_key``, by which the service recognizes them.

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
    return HttpCall(_path(exercise), ExerciseView.model_validate_json)


def next_robot(
    level: int = 1, convention: Convention = Convention.STANDARD, after: str | None = None
) -> HttpCall[PracticeRobot]:
    """Return a generated robot to practise with; ``after`` is the id of the previous robot."""
    given = {"level": level, "convention": convention.value, "after": after}
    query = urlencode({name: value for name, value in given.items() if value is not None})
    return HttpCall(f"v1/practice/next?{query}", PracticeRobot.model_validate_json)


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
    return HttpCall(f"{_path(exercise)}/grade", read_report, body, idempotency_key or _new_key())


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
    return HttpCall(f"{_path(exercise)}/hints", Hint.model_validate_json, body)


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


def _path(exercise: str) -> str:
    return "v1/exercises/" + quote(exercise, safe="").replace(".", "%2E")


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
