"""Fair admission: requests come in turn by client, one at a time, and nobody's queue is endless.

A grading keeps the process busy until it is done. What arrives meanwhile must be heard before the
next is begun: else a client that sends on many connections at once is served on all of them first.
"""

import asyncio
import math
from collections.abc import Awaitable, Callable, Generator
from functools import partial
from time import thread_time
from typing import Any, Final

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.server.crowd import client_key
from service.server.fair_queue import FairQueue, Ticket
from service.server.limits import HEALTH
from service.server.refusals import too_busy, too_many
from service.submissions.strict_json import MAX_BODY_SIZE

# What may wait of one client, and of all: requests and bytes. A class behind one address, 120
# submissions in the same second, is served within that second.
OF_ONE: Final = (128, 8 * 1024 * 1024)
OF_ALL: Final = (1024, 32 * 1024 * 1024)
# The share of the last request in the mean time that a request takes.
_RECENT: Final = 0.02
_LONGEST_RETRY: Final = 30


class Metered:
    """An awaitable that notes the processor time of its own steps, whatever runs between them."""

    def __init__(self, awaitable: Awaitable[None]) -> None:
        self._awaitable = awaitable
        self.seconds = 0.0

    def __await__(self) -> Generator[Any, Any, None]:
        """Run the steps."""
        steps = self._awaitable.__await__()
        resume: Callable[[], Any] = partial(next, steps)
        while True:
            began = thread_time()
            try:
                awaited = resume()
            except StopIteration:
                return
            finally:
                self.seconds += thread_time() - began
            try:
                value = yield awaited
            except BaseException as error:  # noqa: BLE001 - handed on to where it belongs
                resume = partial(steps.throw, error)
            else:
                resume = partial(steps.send, value)


class FairAdmission:
    """Lets whole requests through to the application one by one, in turn by client."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self._queue = FairQueue()
        # Whether a request has been begun since the sockets were looked at.
        self._taken = False
        self._mean = 0.0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        if scope["type"] != "http" or scope["path"] in HEALTH:
            await self.app(scope, receive, send)
            return
        body, ended = await _body(receive)
        if body is None:
            return
        host, port = scope.get("client") or ("", 0)
        ticket = Ticket(client_key(host), port, len(body))
        if self._taken:
            refusal = self._refusal(ticket)
            if refusal is not None:
                await refusal.response(scope["path"])(scope, receive, send)
                return
            await self._turn(ticket)
            if ended and _gone(receive):
                return
        else:
            self._begin()
            self._queue.begin(ticket)
        metered = Metered(self.app(scope, _again(body, ended, receive), send))
        try:
            await metered
        finally:
            self._queue.charge(ticket, metered.seconds)
            self._mean += _RECENT * (metered.seconds - self._mean)

    def _refusal(self, ticket: Ticket) -> Any:
        """The problem of a request for which there is no place in the queue, or None."""
        queue = self._queue
        requests, size = queue.of(ticket.client)
        if requests >= OF_ONE[0] or size + ticket.size > OF_ONE[1]:
            return too_many(self._seconds(requests))
        if len(queue) >= OF_ALL[0] or queue.size + ticket.size > OF_ALL[1]:
            return too_busy(self._seconds(len(queue)))
        return None

    def _seconds(self, requests: int) -> int:
        return min(max(1, math.ceil(requests * self._mean)), _LONGEST_RETRY)

    async def _turn(self, ticket: Ticket) -> None:
        """Wait until it is this request's turn."""
        ticket.turn = asyncio.get_running_loop().create_future()
        self._queue.push(ticket)
        await ticket.turn

    def _begin(self) -> None:
        """Take the place of the request that is begun until the sockets have been looked at."""
        self._taken = True
        # Twice: what is called soon once comes before what the sockets have.
        loop = asyncio.get_running_loop()
        loop.call_soon(loop.call_soon, self._next)

    def _next(self) -> None:
        """Begin the request whose turn it is."""
        self._taken = False
        while len(self._queue):
            ticket = self._queue.pop()
            if not ticket.turn.done():
                ticket.turn.set_result(None)
                self._begin()
                return


async def _body(receive: Receive) -> tuple[bytes | None, bool]:
    """The body, and whether it is whole: not more of it than the application takes.

    None where the client has gone.
    """
    parts: list[bytes] = []
    size = 0
    while size <= MAX_BODY_SIZE:
        message = await receive()
        if message["type"] == "http.disconnect":
            return None, False
        parts.append(message.get("body", b""))
        size += len(parts[-1])
        if not message.get("more_body", False):
            return b"".join(parts), True
    return b"".join(parts), False


def _gone(receive: Receive) -> bool:
    """Whether the client has hung up, without waiting for what it does next.

    Starlette's question after it lets the loop run on, and the next request would be begun.
    """
    asking = receive().__await__()
    try:
        next(asking)
    except StopIteration as told:
        return bool(told.value["type"] == "http.disconnect")
    asking.close()
    return False


def _again(body: bytes, ended: bool, receive: Receive) -> Receive:
    """What gives the body once more, and then what comes after it."""
    first: Message | None = {"type": "http.request", "body": body, "more_body": not ended}

    async def replay() -> Message:
        nonlocal first
        if first is None:
            return await receive()
        message, first = first, None
        return message

    return replay
