"""Fair admission: requests come in turn by client, and nobody's queue is endless.

A grading keeps the process busy until it is done. What arrives meanwhile must be heard before the
next is begun: else a client that sends on many connections at once is served on all of them first.
A request of many gradings gives way after each. Looking at the sockets after each small request
would cost as much as the request, so these go on for a slice of time.

Requests that are likely to be costly have a queue of their own. While there are ordinary ones, the
process rests from costly ones after each, by far longer than it took: so few of the others find it
busy, whether they come in a row or now and then, from the same address or not.
"""

import asyncio
import math
from collections import deque
from collections.abc import Awaitable, Callable, Generator
from functools import partial
from time import thread_time
from typing import Any, Final

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.problems import ProblemError
from service.api.turns import TURN
from service.server.costs import Costs
from service.server.crowd import client_key
from service.server.fair_queue import FairQueue, Ticket
from service.server.limits import HEALTH
from service.server.refusals import too_busy, too_many
from service.submissions.strict_json import MAX_BODY_SIZE

# What may wait of one client, and of all: requests and bytes. A class behind one address, 120
# submissions in the same second, is served within that second.
OF_ONE: Final = (128, 8 * 1024 * 1024)
OF_ALL: Final = (1024, 32 * 1024 * 1024)
# Seconds of processor time until the sockets are looked at, and how many requests are called up at
# once to use them.
SLICE: Final = 0.002
_CALLED: Final = 8
# How many answers on health, and how many refusals, are given each time the sockets are looked at.
# On a thousand connections, they alone would keep the process busy.
SMALL: Final = 4
# Seconds without an ordinary request after which costly ones need not rest.
_CALM: Final = 1.0
# The share of the last request in the mean time that a request takes.
_RECENT: Final = 0.02
_LONGEST_RETRY: Final = 30


class Metered:
    """An awaitable that notes the processor time of its own steps, whatever runs between them."""

    def __init__(self, awaitable: Awaitable[None]) -> None:
        self._awaitable = awaitable
        self._seconds = 0.0
        self._began: float | None = None

    @property
    def seconds(self) -> float:
        """The time so far, that of an unfinished step included."""
        return self._seconds + (0.0 if self._began is None else thread_time() - self._began)

    def __await__(self) -> Generator[Any, Any, None]:
        """Run the steps."""
        steps = self._awaitable.__await__()
        resume: Callable[[], Any] = partial(next, steps)
        while True:
            self._began = thread_time()
            try:
                awaited = resume()
            except StopIteration:
                return
            finally:
                self._seconds, self._began = self.seconds, None
            try:
                value = yield awaited
            except BaseException as error:  # noqa: BLE001 - handed on to where it belongs
                resume = partial(steps.throw, error)
            else:
                resume = partial(steps.send, value)


class _Lane:
    """Small answers of one kind: those given since the sockets were looked at, those that wait."""

    def __init__(self) -> None:
        self.given = 0
        self.waiting: deque[asyncio.Future[None]] = deque()


class FairAdmission:
    """Lets whole requests through to the application one by one, in turn by client."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self._costs = Costs()
        self._ordinary, self._costly = FairQueue(), FairQueue()
        # The times of the loop at which a costly one ended, and an ordinary one came.
        self._costly_ended = self._ordinary_came = float("-inf")
        self._alarm: asyncio.TimerHandle | None = None
        # Processor time since the sockets were looked at; whether they will be.
        self._spent = 0.0
        self._looking = False
        # Of their own each: a thousand refusals must not make a question about health wait.
        self._health, self._refusals = _Lane(), _Lane()
        self._mean = 0.0

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
        host, port = scope.get("client") or ("", 0)
        ticket = Ticket(client_key(host), port, len(body))
        queue = self._queue(ticket)
        if self._others_first(queue):
            refusal = self._refusal(ticket)
            if refusal is not None:
                body = b""
                await self._small_turn(self._refusals)
                await refusal.response(scope["path"])(scope, receive, send)
                return
            queue = await self._turn(ticket)
            if ended and _gone(receive):
                return
        queue.begin(ticket)
        charged = 0.0

        async def turn() -> None:
            nonlocal charged, queue
            charged += self._charge(queue, ticket, metered.seconds - charged)
            queue = self._queue(ticket)
            if self._others_first(queue):
                queue = await self._turn(ticket)
                if ended and _gone(receive):
                    raise ClientDisconnect
            queue.begin(ticket)

        inner = {**scope, TURN: turn}
        metered = Metered(self.app(inner, _again(body, ended, receive), send))
        try:
            await metered
        finally:
            self._charge(queue, ticket, metered.seconds - charged)

    def _queue(self, ticket: Ticket) -> FairQueue:
        """The queue of a request that has come."""
        expected = self._costs.expected(ticket)
        if self._costs.is_costly(expected):
            ticket.expected = expected
            return self._costly
        ticket.expected = 0.0
        self._ordinary_came = asyncio.get_running_loop().time()
        return self._ordinary

    def _others_first(self, queue: FairQueue) -> bool:
        """Whether others wait, or have to be heard first."""
        return len(self._ordinary) > 0 or self._spent >= SLICE or queue is self._costly

    def _charge(self, queue: FairQueue, ticket: Ticket, seconds: float) -> float:
        """Charge what a request, or one of its gradings, has taken; return it."""
        self._spent += seconds
        self._look_soon()
        queue.charge(ticket, seconds)
        self._costs.note(ticket, seconds, ordinary=queue is self._ordinary)
        if queue is self._costly or self._costs.is_costly(seconds):
            self._costly_ended = asyncio.get_running_loop().time()
        self._mean += _RECENT * (seconds - self._mean)
        return seconds

    def _refusal(self, ticket: Ticket) -> ProblemError | None:
        """The problem of a request for which there is no place in the queues, or None."""
        queues = (self._ordinary, self._costly)
        requests, size = map(sum, zip(*(queue.of(ticket.client) for queue in queues), strict=True))
        if requests >= OF_ONE[0] or size + ticket.size > OF_ONE[1]:
            return too_many(self._seconds(requests))
        requests = sum(map(len, queues))
        if requests >= OF_ALL[0] or sum(q.size for q in queues) + ticket.size > OF_ALL[1]:
            return too_busy(self._seconds(requests))
        return None

    def _seconds(self, requests: int) -> int:
        return min(max(1, math.ceil(requests * self._mean)), _LONGEST_RETRY)

    async def _turn(self, ticket: Ticket) -> FairQueue:
        """Wait until it is this request's turn and there is time; the queue that it came from."""
        before = None
        while True:
            # Others like it may have been costly meanwhile.
            queue = self._queue(ticket)
            ticket.turn = asyncio.get_running_loop().create_future()
            queue.push(ticket, again=queue is before)
            self._look_soon()
            await ticket.turn
            if self._spent < SLICE and (queue is self._costly or queue is self._queue(ticket)):
                return queue
            before = queue

    async def _small_turn(self, lane: _Lane) -> None:
        """Wait, where too many small answers are asked for at once."""
        if lane.given >= SMALL:
            turn = asyncio.get_running_loop().create_future()
            lane.waiting.append(turn)
            await turn
        else:
            lane.given += 1
            self._look_soon()

    def _look_soon(self) -> None:
        """Go on as soon as the sockets have been looked at."""
        if not self._looking:
            self._looking = True
            # Twice: what is called soon once comes before what the sockets have.
            loop = asyncio.get_running_loop()
            loop.call_soon(loop.call_soon, self._next)

    def _next(self) -> None:
        """Call up those whose turn it is; who finds no time waits again."""
        self._looking, self._spent = False, 0.0
        called = self._call_costly()
        if not called:
            while len(self._ordinary) and called < _CALLED:
                called += _wake(self._ordinary.pop().turn)
        for lane in (self._health, self._refusals):
            lane.given = 0
            while lane.waiting and lane.given < SMALL:
                lane.given += _wake(lane.waiting.popleft())
            called += lane.given
        if called:
            self._look_soon()

    def _call_costly(self) -> int:
        """Call up a costly request if its time has come; how many are called up."""
        called = 0
        loop = asyncio.get_running_loop()
        while len(self._costly) and not called:
            time = self._costly_ended + self._costs.rest(self._costly.next().expected)
            if not len(self._ordinary):
                time = min(time, self._ordinary_came + _CALM)
            if time > loop.time():
                if self._alarm is None:
                    self._alarm = loop.call_at(time, self._ring)
                break
            called += _wake(self._costly.pop().turn)
        return called

    def _ring(self) -> None:
        self._alarm = None
        self._look_soon()


def _wake(turn: asyncio.Future[None]) -> bool:
    """Let the request go on that waits for this, unless it has been given up."""
    if turn.done():
        return False
    turn.set_result(None)
    return True


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
