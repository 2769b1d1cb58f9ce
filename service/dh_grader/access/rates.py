"""Rate limits for keys and addresses.

Which requests are counted is decided by the middleware in ``api/permissions.py``.
"""

import asyncio
import logging
import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from limits import RateLimitItem, parse_many
from limits.errors import ConfigurationError
from limits.storage import MemoryStorage, Storage, storage_from_string
from limits.storage.base import SlidingWindowCounterSupport
from limits.strategies import SlidingWindowCounterRateLimiter

from dh_grader.access import Caller, client_key
from dh_grader.translations import say

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
    """Counts requests in the memory of this process, or in a Redis that processes share.

    While Redis does not respond, each process counts on its own.
    """

    def __init__(self, per_key: str = "", per_address: str = "", store: str = "memory://") -> None:
        # The limits are texts for ``rates_in``. Raises UnusableRatesError.
        self._per_key = rates_in(per_key) if per_key else ()
        self._per_address = rates_in(per_address) if per_address else ()
        self._own = SlidingWindowCounterRateLimiter(MemoryStorage())
        self._shared: SlidingWindowCounterRateLimiter | None = None
        self._threads = ThreadPoolExecutor(4, "rates")
        if not store.startswith("memory:"):
            self._shared = SlidingWindowCounterRateLimiter(_storage(store))

    def most_at_once(self, caller: Caller) -> float:
        """Return the most requests that may be counted for the caller at once."""
        return min((rate.amount for rate in self._of(caller)), default=math.inf)

    async def seconds_to_wait(self, caller: Caller, address: str, requests: int = 1) -> int:
        """Count requests; return 0 if they are allowed, otherwise the seconds to wait.

        If the requests are not allowed, none of them is counted.
        """
        # A request with a key counts for the key's owner, any other request for its address. All
        # IPv6 addresses of a /64 network count as one address.
        owner, rates = caller.owner, self._of(caller)
        if not rates:
            return 0
        counted = ("key", owner) if owner else ("address", client_key(address))
        if self._shared is not None:
            loop = asyncio.get_running_loop()
            try:
                return await loop.run_in_executor(
                    self._threads, _hit, self._shared, rates, counted, requests
                )
            except Exception as error:  # noqa: BLE001 - its type depends on the client library
                _log.warning("The store of rates does not respond: %s", type(error).__name__)
        return _hit(self._own, rates, counted, requests)

    def close(self) -> None:
        """Stop the threads."""
        self._threads.shutdown(wait=False)

    def _of(self, caller: Caller) -> Sequence[RateLimitItem]:
        return self._per_key if caller.owner else self._per_address


def _hit(
    limiter: SlidingWindowCounterRateLimiter,
    rates: Sequence[RateLimitItem],
    counted: tuple[str, str],
    requests: int,
) -> int:
    # Tested before any limit is charged: a refused request counts in none of them.
    waits = [_wait(limiter.storage, rate, counted, requests) for rate in rates]
    if any(waits):
        return max(waits)
    for rate in rates:
        if not limiter.hit(rate, *counted, cost=requests):
            # Another process was faster.
            return max(1, _wait(limiter.storage, rate, counted, requests))
    return 0


def _wait(storage: object, rate: RateLimitItem, counted: tuple[str, str], requests: int) -> int:
    # The limiter counts the requests of the current window, and those of the previous window by
    # the share of it that is less than a whole window ago. It rounds this sum down. A window is
    # kept for another one after its end, and ``now_left`` is the time until it is deleted.
    assert isinstance(storage, SlidingWindowCounterSupport)
    window = rate.get_expiry()
    before, before_left, now, now_left = storage.get_sliding_window(rate.key_for(*counted), window)
    allowed = rate.amount - requests + 1
    if before * before_left / window + now < allowed:
        return 0
    if now < allowed and before:
        # Until enough of the previous window has passed.
        return max(1, math.ceil(before_left - (allowed - now) * window / before))
    # Until enough of the current window has passed, which is the previous one then.
    return max(1, math.ceil(now_left - max(0, allowed) * window / max(1, now)))


def _storage(address: str) -> Storage:
    try:
        # The time limit of the Redis client (seconds), also for connecting: no request waits long.
        storage = storage_from_string(address, socket_timeout=1)
    except ConfigurationError as error:
        raise UnusableRatesError(
            say("is not a store of counts; write redis://host:6379/0, or leave it out")
        ) from error
    if not isinstance(storage, Storage):
        raise UnusableRatesError(
            say("is not a store of counts; write redis://host:6379/0, or leave it out")
        )
    return storage
