"""The client for asyncio."""

import asyncio
from collections.abc import AsyncIterator, Iterable, Mapping
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


class AsyncGraderClient:
    """Calls a DH Grader; several tasks may share it. Every method raises GraderClientError.

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
        transport: httpx.AsyncBaseTransport | None = None,
    ) -> None:
        self.server = checked_server(server)
        self._timeout = timeout
        self._retries = retries
        options = client_options(self.server, key, timeout)
        self._http = httpx.AsyncClient(transport=transport, **options)

    async def exercises(self) -> list[ExerciseSummary]:
        """Return the exercises of the service."""
        return await self._result(calls.listing())

    async def exercise(self, exercise: str) -> ExerciseView:
        """Return the exercise with this id as students see it."""
        return await self._result(calls.showing(exercise))

    async def grade(
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
        return await self._result(calls.grading(exercise, request, idempotency_key))

    async def grade_many(
        self, submissions: Iterable[ExerciseSubmission]
    ) -> AsyncIterator[GradeResult]:
        """Grade submissions; yield the results in order, each a report or a problem.

        The submissions are sent in as few requests as the service's limits allow.
        """
        for call in calls.grading_many(submissions):
            for result in await self._result(call):
                yield result

    async def preview(
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
        return await self._result(calls.previewing(request))

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def __aenter__(self) -> Self:
        await self._http.__aenter__()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        await self._http.__aexit__(kind, error, traceback)

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
