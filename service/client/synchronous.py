"""The client for programs without ``await``."""

import threading
from collections.abc import Iterable, Iterator, Mapping
from types import TracebackType
from typing import Any, Self, TypeVar

import httpx

from service.catalogue import FeedbackLevel
from service.client import calls
from service.client.address import checked_server, client_options
from service.client.answers import AnswerPieces, HttpAnswer, unreachable
from service.client.calls import HttpCall
from service.client.errors import GraderClientError
from service.client.retries import Retries
from service.contract.exercises import ExerciseSummary, ExerciseView
from service.contract.grading import GradeResult
from service.contract.preview import PreviewAnswer, PreviewRequest
from service.expressions import AngleUnit, Kind
from service.grading import Report
from service.submissions.body import ExerciseSubmission

T = TypeVar("T")


class GraderClient:
    """Calls a DH Grader; several threads may share it. Every method raises GraderClientError.

    ``server`` is its address, including a path before ``/v1``. ``key`` is sent only to this server.
    ``timeout`` is the limit for one answer in seconds. ``transport`` is that of httpx, for your own
    certificates or proxies. Raises ValueError for an invalid address or key.
    """

    def __init__(
        self,
        server: str,
        key: str | None = None,
        *,
        timeout: float = 60.0,
        retries: Retries = Retries(),  # noqa: B008 -- frozen
        transport: httpx.BaseTransport | None = None,
    ) -> None:
        self.server = checked_server(server)
        self._timeout = timeout
        self._retries = retries
        self._is_closed = threading.Event()
        options = client_options(self.server, key, timeout)
        self._http = httpx.Client(transport=transport, **options)

    def exercises(self) -> list[ExerciseSummary]:
        """Return the exercises of the service."""
        return self._result(calls.listing())

    def exercise(self, exercise: str) -> ExerciseView:
        """Return the exercise with this id as students see it."""
        return self._result(calls.showing(exercise))

    def grade(
        self,
        exercise: str,
        answers: Mapping[str, Any],
        *,
        angle_unit: AngleUnit = "radians",
        feedback: FeedbackLevel | None = None,
        echo: bool = False,
        idempotency_key: str | None = None,
    ) -> Report:
        """Grade answers to the parts of an exercise, given by part id; return the report.

        Calls with the same ``idempotency_key`` are one submission for the service. By default, each
        call is a new submission; its retries are not.
        """
        request = calls.submission(answers, angle_unit, feedback, echo=echo)
        return self._result(calls.grading(exercise, request, idempotency_key))

    def grade_many(self, submissions: Iterable[ExerciseSubmission]) -> Iterator[GradeResult]:
        """Grade submissions; yield the results in order, each a report or a problem.

        The submissions are sent in as few requests as the service's limits allow.
        """
        for call in calls.grading_many(submissions):
            yield from self._result(call)

    def preview(
        self,
        text: str,
        *,
        exercise: str | None = None,
        part: str | None = None,
        angle_unit: AngleUnit = "radians",
        quantity: Kind = "number",
    ) -> PreviewAnswer:
        """Return how the service reads a text, or why it cannot read it."""
        request = PreviewRequest(
            text=text, exercise=exercise, part=part, angle_unit=angle_unit, quantity=quantity
        )
        return self._result(calls.previewing(request))

    def close(self) -> None:
        """Close the connections and stop all retries."""
        self._is_closed.set()
        self._http.close()

    def __enter__(self) -> Self:
        self._http.__enter__()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._is_closed.set()
        self._http.__exit__(kind, error, traceback)

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
