"""Look up keys in the database, many in one statement."""

import asyncio
from collections import deque
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Final

from service.access.keys import Key, KeysBusyError, KeysUnreachableError

# A column of the table of keys, ``id`` or ``digest``, and the value to find there.
KeyPlace = tuple[str, str]

# The most keys in one statement.
BATCH: Final = 128
# The most waiting look-ups: more than the connections of a process.
MAX_WAITING: Final = 4096
# The time limit of a look-up (seconds). A paused database raises no error.
TIMEOUT: Final = 15.0


class KeyLookups:
    """Looks up keys in one thread, with a pause between two database statements."""

    # A client may send any number of invented keys. They cost little: at most ``1 / pause``
    # statements per second.

    def __init__(
        self, find: Callable[[Collection[KeyPlace]], Mapping[KeyPlace, Key]], pause: float = 0.0
    ) -> None:
        self._find = find
        self._pause = pause
        self._thread = ThreadPoolExecutor(1, "keys-read")
        self._asked: dict[KeyPlace, asyncio.Future[Key | None]] = {}
        self._waiting: deque[KeyPlace] = deque()
        self._working: asyncio.Task[None] | None = None

    async def key(self, place: KeyPlace) -> Key | None:
        """Return the key with this id or digest; None if there is no such key.

        Raises KeysUnreachableError, KeysBusyError.
        """
        asked = self._asked.get(place)
        if asked is None:
            if len(self._waiting) >= MAX_WAITING:
                raise KeysBusyError
            asked = self._asked[place] = asyncio.get_running_loop().create_future()
            # If all callers have gone, ignore the exception instead of logging it.
            asked.add_done_callback(lambda done: done.cancelled() or done.exception())
            self._waiting.append(place)
            if self._working is None or self._working.done():
                self._working = asyncio.create_task(self._process_waiting())
        try:
            # Shield it: others may wait for the same key when this client has gone.
            return await asyncio.wait_for(asyncio.shield(asked), TIMEOUT)
        except TimeoutError as error:
            raise KeysUnreachableError from error

    def close(self) -> None:
        """Stop the thread."""
        self._thread.shutdown()

    async def _process_waiting(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            while self._waiting:
                batch = [self._waiting.popleft() for _ in range(min(BATCH, len(self._waiting)))]
                try:
                    found = await loop.run_in_executor(self._thread, self._find, batch)
                except Exception as error:  # noqa: BLE001 - passed to every waiting caller
                    for place in batch:
                        self._asked.pop(place).set_exception(error)
                else:
                    for place in batch:
                        self._asked.pop(place).set_result(found.get(place))
                await asyncio.sleep(self._pause)
        finally:
            # Something is left only if the event loop ends during a batch.
            for asked in self._asked.values():
                asked.cancel()
            self._asked.clear()
            self._waiting.clear()
