"""Do slow work in a thread, one task at a time, with a short queue."""

import asyncio
from collections.abc import Callable
from http import HTTPStatus
from typing import Final, TypeVar

from service.api.http.problems import ProblemError

T = TypeVar("T")

# The length of the queue. A tutor's page waits for an answer before its next request.
WAITING: Final = 4


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
