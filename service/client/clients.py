"""The clients, with and without ``await``."""

# Their methods build and send the service's calls.

import asyncio
import threading
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable, Iterator
from functools import wraps
from typing import Any, Generic, ParamSpec, Self, TypeVar, overload

import httpx

from service.client import calls, course_calls
from service.client.address import checked_server, client_options
from service.client.answers import AnswerPieces, HttpAnswer, unreachable
from service.client.calls import HttpCall
from service.client.errors import GraderClientError
from service.client.retries import Retries
from service.contract.grading import GradeResult
from service.submissions.body import ExerciseSubmission

P = ParamSpec("P")
T = TypeVar("T")


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
    exercises = _Method(calls.exercises)
    exercise = _Method(calls.exercise)
    next_robot = _Method(calls.next_robot)
    grade = _Method(calls.grade)
    hint = _Method(calls.hint)
    preview = _Method(calls.preview)
    courses = _Method(course_calls.courses)
    create_course = _Method(course_calls.create_course)
    learners = _Method(course_calls.learners)
    add_learners = _Method(course_calls.add_learners)
    links = _Method(course_calls.links)
    revoke_links = _Method(course_calls.revoke_links)
    assignments = _Method(course_calls.assignments)
    create_assignment = _Method(course_calls.create_assignment)
    change_assignment = _Method(course_calls.change_assignment)
    extend = _Method(course_calls.extend)
    variants = _Method(course_calls.variants)
    deal_variant = _Method(course_calls.deal_variant)
    missing = _Method(course_calls.missing)
    scores = _Method(course_calls.scores)
    send_scores = _Method(course_calls.send_scores)
    gradebook = _Method(course_calls.gradebook)
    hand_in = _Method(course_calls.hand_in)
    own_courses = _Method(course_calls.own_courses)
    course = _Method(course_calls.course)
    change_course = _Method(course_calls.change_course)
    delete_course = _Method(course_calls.delete_course)
    remove_learner = _Method(course_calls.remove_learner)
    assignment = _Method(course_calls.assignment)
    delete_assignment = _Method(course_calls.delete_assignment)
    gradebook_file = _Method(course_calls.gradebook_file)
    learner_view = _Method(course_calls.learner_view)
    assigned_solution = _Method(course_calls.assigned_solution)
    regrade = _Method(course_calls.regrade)


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
        retries: Retries = Retries(),  # noqa: B008 -- frozen
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
        """Grade submissions; yield a report or an error for each, in order."""
        # The submissions are sent in as few requests as the service's limits allow.
        for call in calls.grade_many(submissions):
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
        retries: Retries = Retries(),  # noqa: B008 -- frozen
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
        """Grade submissions; yield a report or an error for each, in order."""
        # The submissions are sent in as few requests as the service's limits allow.
        for call in calls.grade_many(submissions):
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
