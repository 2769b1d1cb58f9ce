"""Compute slow results in a thread, one at a time, and memoize them."""

import asyncio
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Final

# A course has a few dozen exercises. A solution or figure takes about ten kilobytes.
MOST_RESULTS: Final = 128


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
