"""Work that takes a while: in a thread, one at a time, and few in the queue."""

import asyncio
from collections.abc import Callable
from http import HTTPStatus
from typing import Final, TypeVar

from service.api.http.problems import ProblemError

T = TypeVar("T")

# A tutor's page sends its next request after the answer to the last one.
WAITING: Final = 4


class BoundedWork:
    """One piece of work at a time, in a thread; whoever finds the queue full is told so."""

    def __init__(self) -> None:
        self._working = asyncio.Lock()
        self._accepted = 0

    async def do(self, work: Callable[[], T]) -> T:
        """The result of ``work``. Raises ProblemError where too many wait."""
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
