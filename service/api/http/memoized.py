"""What takes a while to work out: in a thread, one at a time, and kept."""

import asyncio
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Final

# A course has a few dozen exercises; one solution or figure takes some ten kilobytes.
KEPT: Final = 128


class Kept:
    """The latest results by their keys. Others wait only for a result that is not there yet."""

    def __init__(self) -> None:
        self._kept: OrderedDict[Hashable, bytes] = OrderedDict()
        self._working = asyncio.Lock()

    async def of(self, key: Hashable, work: Callable[[], bytes]) -> bytes:
        """The result with this key; ``work`` finds it."""
        if key not in self._kept:
            async with self._working:
                if key not in self._kept:
                    self._kept[key] = await asyncio.to_thread(work)
                    while len(self._kept) > KEPT:
                        self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]
