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

    ``server`` is its address, with the path before ``/v1`` if there is one. ``key`` is sent to it
    and to nobody else. ``timeout`` are the seconds for one answer. ``transport`` is that of httpx,
    for certificates or proxies of one's own. Raises ValueError for another address or key.
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
        """The exercises of the service."""
        return self._result(calls.listing())

    def exercise(self, exercise: str) -> ExerciseView:
        """The exercise with this id, as a student sees it."""
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
        """The report on answers to the parts of an exercise, by the ids of the parts.

        ``idempotency_key`` tells the service that two calls are one submission; by default each
        call is a submission of its own, however often it is tried.
        """
        request = calls.submission(answers, angle_unit, feedback, echo=echo)
        return self._result(calls.grading(exercise, request, idempotency_key))

    def grade_many(self, submissions: Iterable[ExerciseSubmission]) -> Iterator[GradeResult]:
        """The results of submissions, in their order: each a report, or a problem of that one.

        They come as they are graded, in as few requests as the service's limits allow.
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
        """The reading of a text, or the reason why it cannot be read."""
        request = PreviewRequest(
            text=text, exercise=exercise, part=part, angle_unit=angle_unit, quantity=quantity
        )
        return self._result(calls.previewing(request))

    def close(self) -> None:
        """Close the connections, and try nothing again."""
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
                # Whoever closes the client need not wait for the waits of other threads.
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
