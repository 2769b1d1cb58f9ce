"""Look-ups of keys in the database: all that wait go into one statement."""

import asyncio
from collections import deque
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Final

from service.access.keys import Key, KeysBusyError, KeysUnreachableError

# A column of the table of keys, ``id`` or ``digest``, and the value to find there.
KeyPlace = tuple[str, str]

# How many keys one statement looks up.
TOGETHER: Final = 128
# How many may wait: more than the connections of a process.
WAITING: Final = 4096
# Seconds that a look-up may take. A database that is paused raises no error.
PATIENCE: Final = 15.0


class KeyLookups:
    """Look-ups in one thread, one statement after the other, with a pause in between.

    A client that invents keys can have any number of them looked up. So their number costs the
    database and the process little: at most ``1 / pause`` statements a second.
    """

    def __init__(
        self, find: Callable[[Collection[KeyPlace]], Mapping[KeyPlace, Key]], pause: float = 0.0
    ) -> None:
        """Take the function that finds keys in the database; it runs in the thread."""
        self._find = find
        self._pause = pause
        self._thread = ThreadPoolExecutor(1, "keys-read")
        self._asked: dict[KeyPlace, asyncio.Future[Key | None]] = {}
        self._waiting: deque[KeyPlace] = deque()
        self._working: asyncio.Task[None] | None = None

    async def key(self, place: KeyPlace) -> Key | None:
        """Return the key there, or None. Raises KeysUnreachableError, KeysBusyError."""
        asked = self._asked.get(place)
        if asked is None:
            if len(self._waiting) >= WAITING:
                raise KeysBusyError
            asked = self._asked[place] = asyncio.get_running_loop().create_future()
            # A failure that nobody waits for any more is no failure of the program.
            asked.add_done_callback(lambda done: done.cancelled() or done.exception())
            self._waiting.append(place)
            if self._working is None or self._working.done():
                self._working = asyncio.create_task(self._work_off())
        try:
            # Others may wait for it when this client has gone.
            return await asyncio.wait_for(asyncio.shield(asked), PATIENCE)
        except TimeoutError as error:
            raise KeysUnreachableError from error

    def close(self) -> None:
        """End the thread."""
        self._thread.shutdown()

    async def _work_off(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            while self._waiting:
                batch = [self._waiting.popleft() for _ in range(min(TOGETHER, len(self._waiting)))]
                try:
                    found = await loop.run_in_executor(self._thread, self._find, batch)
                except Exception as error:  # noqa: BLE001 - each that waits gets it
                    for place in batch:
                        self._asked.pop(place).set_exception(error)
                else:
                    for place in batch:
                        self._asked.pop(place).set_result(found.get(place))
                await asyncio.sleep(self._pause)
        finally:
            # Only where the loop ends in the midst is anything left.
            for asked in self._asked.values():
                asked.cancel()
            self._asked.clear()
            self._waiting.clear()
