"""LTI 1.3: platforms that launch courses, and the threads in which this service asks them.

The other files check launches, fetch from platforms and send scores. HTTP is in ``web``.
"""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from typing import Final, TypeVar

# --- Threads that wait for platforms, so that no other work waits with them


R = TypeVar("R")

_MOST: Final = 32
# Of one platform: a slow one leaves threads for the others.
_MOST_EACH: Final = 4


class PlatformThreads:
    """A few threads in which this process asks platforms, apart from the threads of other work."""

    def __init__(self) -> None:
        # No thread starts before it is needed.
        self._pool = ThreadPoolExecutor(_MOST, "lti-platform")
        self._turns: dict[str, asyncio.Semaphore] = {}

    async def run(self, platform: str, work: Callable[[], R]) -> R:
        """Return the result of ``work``, which asks this platform, from one of the threads.

        Work for the same platform may have to wait.
        """
        turns = self._turns.setdefault(platform, asyncio.Semaphore(_MOST_EACH))
        await turns.acquire()
        loop = asyncio.get_running_loop()
        result = loop.run_in_executor(self._pool, copy_context().run, work)
        # A caller that is cancelled leaves a thread at work: its turn ends with the work.
        result.add_done_callback(lambda _: turns.release())
        return await asyncio.shield(result)

    def close(self) -> None:
        """End the threads after their current work."""
        self._pool.shutdown(wait=False, cancel_futures=True)
