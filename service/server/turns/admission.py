"""Schedule the requests of clients fairly, in time slices of a few milliseconds.

After each slice, the connection that has used the least processor time may continue.
"""

# Small requests share a slice, because reading the sockets costs as much as answering one of them.

import asyncio
import math
from collections import deque
from collections.abc import Awaitable, Callable, Generator
from datetime import UTC, datetime
from functools import partial
from time import thread_time
from typing import Any, Final

from starlette.requests import ClientDisconnect, HTTPConnection
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.access.client_key import client_key
from service.api.http.language import language_of
from service.api.http.problems import ProblemError
from service.api.turns import ARRIVED, CLIENT, ONE_ADDRESS, TURN, Client
from service.server.limits import HEALTH
from service.server.refusals import too_busy, too_many
from service.server.turns.fair_queue import FairQueue, Ticket
from service.server.turns.speed import Speed
from service.submissions.strict_json import MAX_BODY_SIZE
from service.time_slices import SLICE

# How many requests, and how many bytes of them, may wait: of one client, and of all. A class behind
# one address sends 400 submissions in the same second before a deadline.
OF_ONE: Final = (512, 16 * 1024 * 1024)
OF_ALL: Final = (1024, 32 * 1024 * 1024)
# How many health checks, and how many refusals, are answered after each reading of the sockets.
# Without this limit, a thousand connections could keep the process busy with them alone.
SMALL: Final = 4
# The weight of the last request in the moving average of the time of a request.
_RECENT: Final = 0.1
_LONGEST_RETRY: Final = 30


class Metered:
    """An awaitable that measures the processor time of its own steps."""

    def __init__(self, awaitable: Awaitable[None]) -> None:
        self._awaitable = awaitable
        self._spent = 0.0
        self._began: float | None = None

    @property
    def spent(self) -> float:
        """The processor seconds so far, including an unfinished step."""
        return self._spent + (0.0 if self._began is None else thread_time() - self._began)

    def __await__(self) -> Generator[Any, Any, None]:
        steps = self._awaitable.__await__()
        resume: Callable[[], Any] = partial(next, steps)
        while True:
            self._began = thread_time()
            try:
                awaited = resume()
            except StopIteration:
                return
            finally:
                self._spent, self._began = self.spent, None
            try:
                value = yield awaited
            except BaseException as error:  # noqa: BLE001 - passed on to the awaitable
                resume = partial(steps.throw, error)
            else:
                resume = partial(steps.send, value)


class _Lane:
    # The number starts at 0 whenever the process has read its sockets.
    def __init__(self) -> None:
        self.given = 0
        self.waiting: deque[asyncio.Future[None]] = deque()


class FairAdmission:
    """Middleware that shares the processor fairly between the requests of clients."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self._speed = Speed()
        self._queue = FairQueue(self._speed.ordinary)
        # Processor time since the sockets were read; True if the next reading is scheduled.
        self._spent = 0.0
        self._reading = False
        # The mean processor time of a request.
        self._mean = 0.0
        # Two lanes: a thousand refusals must not delay a health check.
        self._health, self._refusals = _Lane(), _Lane()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one ASGI connection."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        if scope["path"] in HEALTH:
            await self._small_turn(self._health)
            await self.app(scope, receive, send)
            return
        body, ended = await _body(receive)
        if body is None:
            return
        scope[ARRIVED] = datetime.now(UTC)
        host, port = scope.get("client") or ("", 0)
        client = scope.get(CLIENT) or Client(client_key(host), ONE_ADDRESS)
        ticket = Ticket(client, port, len(body))
        refusal = self._refusal(ticket) if self._must_wait else None
        if refusal is not None:
            body = b""
            await self._small_turn(self._refusals)
            language = language_of(HTTPConnection(scope))
            await refusal.response(scope["path"], language)(scope, receive, send)
            return
        self._queue.enter(ticket)
        try:
            await self._serve(ticket, scope, _Replayed(body, ended, receive), send)
        finally:
            self._queue.leave(ticket)

    async def _serve(self, ticket: Ticket, scope: Scope, body: "_Replayed", send: Send) -> None:
        charged = 0.0

        async def give_way() -> None:
            nonlocal charged
            self._charge(ticket, metered.spent - charged)
            charged = metered.spent
            await self._turn(ticket, body)

        try:
            await self._turn(ticket, body)
        except ClientDisconnect:
            return
        metered = Metered(self.app({**scope, TURN: give_way}, body.receive, send))
        try:
            await metered
        finally:
            self._charge(ticket, metered.spent - charged)
            self._queue.ordinary = self._speed.after_request()
            self._mean += _RECENT * (metered.spent - self._mean)

    @property
    def waiting(self) -> int:
        """The number of waiting requests."""
        return self._queue.length

    @property
    def _must_wait(self) -> bool:
        return self._queue.length > 0 or self._spent >= SLICE

    def _charge(self, ticket: Ticket, seconds: float) -> None:
        self._spent += seconds
        self._queue.charge(ticket, seconds)
        self._read_soon()

    def _refusal(self, ticket: Ticket) -> ProblemError | None:
        requests, size = self._queue.waiting(ticket.client)
        is_beyond = requests >= OF_ONE[0] or size + ticket.size > OF_ONE[1]
        if is_beyond and not ticket.client.is_trusted:
            return too_many(self._seconds(requests))
        if self._queue.length >= OF_ALL[0] or self._queue.size + ticket.size > OF_ALL[1]:
            return too_busy(self._seconds(self._queue.length))
        return None

    def _seconds(self, requests: int) -> int:
        return min(max(1, math.ceil(requests * self._mean)), _LONGEST_RETRY)

    async def _turn(self, ticket: Ticket, body: "_Replayed") -> None:
        # Raises ClientDisconnect if the client has gone.
        if self._must_wait:
            ticket.turn = asyncio.get_running_loop().create_future()
            self._queue.push(ticket)
            self._read_soon()
            try:
                await ticket.turn
            except asyncio.CancelledError:
                self._queue.remove(ticket)
                # The process ends, and all connections have been closed.
                if body.is_unwanted():
                    raise ClientDisconnect from None
                raise
            if body.is_unwanted():
                raise ClientDisconnect

    async def _small_turn(self, lane: _Lane) -> None:
        if lane.given >= SMALL:
            turn = asyncio.get_running_loop().create_future()
            lane.waiting.append(turn)
            await turn
        else:
            lane.given += 1
            self._read_soon()

    def _read_soon(self) -> None:
        if not self._reading:
            self._reading = True
            # Twice: a callback that is scheduled once runs before the sockets are read.
            loop = asyncio.get_running_loop()
            loop.call_soon(loop.call_soon, self._next)

    def _next(self) -> None:
        self._reading, self._spent = False, 0.0
        called = 0
        while self._queue.length and not called:
            called += _wake(self._queue.pop().turn)
        for lane in (self._health, self._refusals):
            lane.given = 0
            while lane.waiting and lane.given < SMALL:
                lane.given += _wake(lane.waiting.popleft())
            called += lane.given
        if called:
            self._read_soon()


def _wake(turn: asyncio.Future[None]) -> bool:
    if turn.done():
        return False
    turn.set_result(None)
    return True


async def _body(receive: Receive) -> tuple[bytes | None, bool]:
    # A body beyond the application's limit is not read to its end. The body is None if the client
    # has gone.
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


class _Replayed:
    def __init__(self, body: bytes, ended: bool, receive: Receive) -> None:
        self._first: Message | None = {
            "type": "http.request", "body": body, "more_body": not ended,
        }  # fmt: skip
        self._ended = ended
        self._receive = receive

    async def receive(self) -> Message:
        if self._first is None:
            return await self._receive()
        message, self._first = self._first, None
        return message

    def is_unwanted(self) -> bool:
        # Do not wait for the client: Starlette's ``is_disconnected`` would let the event loop begin
        # the next request.
        if not self._ended:
            return False
        asking = self._receive().__await__()
        try:
            next(asking)
        except StopIteration as received:
            return bool(received.value["type"] == "http.disconnect")
        asking.close()
        return False
