"""Rate limits for keys and addresses."""

import asyncio
import logging
import math
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from limits import RateLimitItem, parse_many
from limits.errors import ConfigurationError
from limits.storage import MemoryStorage, Storage, storage_from_string
from limits.strategies import SlidingWindowCounterRateLimiter

from service.access.caller import Caller
from service.access.client_key import client_key
from service.translations import say

_log = logging.getLogger(__name__)


class UnusableRatesError(Exception):
    """A rate limit or its counter cannot be used; the message says why."""


def rates_in(text: str) -> Sequence[RateLimitItem]:
    """Parse rate limits such as ``20/second;600/minute``. Raises UnusableRatesError."""
    try:
        return parse_many(text)
    except ValueError as error:
        raise UnusableRatesError(
            say(
                "{text!r} is not a rate; write 600/minute, or several with semicolons between them",
                text=text,
            )
        ) from error


class Rates:
    """Counts requests in the memory of this process, or in a Redis that processes share."""

    # While Redis does not respond, each process counts on its own.

    def __init__(self, per_key: str = "", per_address: str = "", store: str = "memory://") -> None:
        # The limits are texts for ``rates_in``. Raises UnusableRatesError.
        self._per_key = rates_in(per_key) if per_key else ()
        self._per_address = rates_in(per_address) if per_address else ()
        self._own = SlidingWindowCounterRateLimiter(MemoryStorage())
        self._shared: SlidingWindowCounterRateLimiter | None = None
        self._threads = ThreadPoolExecutor(4, "rates")
        if not store.startswith("memory:"):
            self._shared = SlidingWindowCounterRateLimiter(_storage(store))

    async def seconds_to_wait(self, caller: Caller, address: str) -> int:
        """Count a request; return 0 if it is allowed, otherwise the seconds to wait."""
        # A request with a key counts for the key's owner, any other request for its address. All
        # IPv6 addresses of a /64 network count as one address.
        owner = caller.owner
        rates = self._per_key if owner else self._per_address
        if not rates:
            return 0
        counted = ("key", owner) if owner else ("address", client_key(address))
        if self._shared is not None:
            loop = asyncio.get_running_loop()
            try:
                return await loop.run_in_executor(self._threads, _hit, self._shared, rates, counted)
            except Exception as error:  # noqa: BLE001 - its type depends on the client library
                _log.warning("The store of rates does not respond: %s", type(error).__name__)
        return _hit(self._own, rates, counted)

    def close(self) -> None:
        """Stop the threads."""
        self._threads.shutdown(wait=False)


def _hit(
    limiter: SlidingWindowCounterRateLimiter,
    rates: Sequence[RateLimitItem],
    counted: tuple[str, str],
) -> int:
    for rate in rates:
        if not limiter.hit(rate, *counted):
            reset = limiter.get_window_stats(rate, *counted).reset_time
            return max(1, math.ceil(reset - time.time()))
    return 0


def _storage(address: str) -> Storage:
    try:
        # Both are options of the Redis client: no request waits long for a count.
        storage = storage_from_string(address, socket_timeout=1, socket_connect_timeout=1)
    except ConfigurationError as error:
        raise UnusableRatesError(
            say("is not a store of counts; write redis://host:6379/0, or leave it out")
        ) from error
    if not isinstance(storage, Storage):
        raise UnusableRatesError(
            say("is not a store of counts; write redis://host:6379/0, or leave it out")
        )
    return storage
