"""Fair admission: requests come in turn by client, and nobody's queue is endless.

A grading keeps the process busy until it is done. What arrives meanwhile must be heard before the
next is begun: else a client that sends on many connections at once is served on all of them first.
A request of many gradings gives way after each. Looking at the sockets after each small request
would cost as much as the request, so these go on for a slice of time.

Requests that are likely to be costly have queues of their own, one for each class of cost. As long
as there are ordinary ones now and then, the process rests from costly ones after each, by far
longer than it took: so few of the others find it busy, whether they come in a row or not, from the
same address or not. An ordinary one that is taken for costly waits for few and short rests.
"""

import asyncio
import math
from collections import deque
from collections.abc import Awaitable, Callable, Generator, Iterable
from functools import partial
from time import monotonic, thread_time
from typing import Any, Final, NamedTuple

from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.problems import ProblemError
from service.api.turns import CLIENT, TURN
from service.server.costs import CLASSES, REST, Costs, rest
from service.server.crowd import client_key
from service.server.fair_queue import FairQueue, Ticket
from service.server.limits import HEALTH
from service.server.pace import unit
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
# Seconds without an ordinary request after which costly ones need not rest. Few students may come
# only now and then.
_CALM: Final = 10.0
# The share of the last request in the mean time that a request takes.
_RECENT: Final = 0.1
_LONGEST_RETRY: Final = 30


class Spent(NamedTuple):
    """Seconds that a request takes: of the processor, and of everybody who waits for it."""

    work: float
    elapsed: float

    @staticmethod
    def now() -> "Spent":
        """The clocks of both."""
        return Spent(thread_time(), monotonic())

    def since(self, other: "Spent") -> "Spent":
        """What has been spent since then."""
        return Spent(self.work - other.work, self.elapsed - other.elapsed)

    def plus(self, other: "Spent") -> "Spent":
        """Both together."""
        return Spent(self.work + other.work, self.elapsed + other.elapsed)


class Metered:
    """An awaitable that notes the time of its own steps, whatever runs between them."""

    def __init__(self, awaitable: Awaitable[None]) -> None:
        self._awaitable = awaitable
        self._spent = Spent(0.0, 0.0)
        self._began: Spent | None = None

    @property
    def spent(self) -> Spent:
        """The time so far, that of an unfinished step included."""
        return (
            self._spent if self._began is None else self._spent.plus(Spent.now().since(self._began))
        )

    def __await__(self) -> Generator[Any, Any, None]:
        """Run the steps."""
        steps = self._awaitable.__await__()
        resume: Callable[[], Any] = partial(next, steps)
        while True:
            self._began = Spent.now()
            try:
                awaited = resume()
            except StopIteration:
                return
            finally:
                self._spent, self._began = self.spent, None
            try:
                value = yield awaited
            except BaseException as error:  # noqa: BLE001 - handed on to where it belongs
                resume = partial(steps.throw, error)
            else:
                resume = partial(steps.send, value)


class _Class:
    """The requests of one class of cost, and the time of the loop from which one may be begun."""

    def __init__(self, number: int) -> None:
        self.number = number
        self.queue = FairQueue()
        self.ready = float("-inf")
        # Processor time of a whole request, with all its gradings.
        self.mean = 0.0

    def note_whole(self, seconds: float) -> None:
        """Note what a request has taken."""
        self.mean += _RECENT * (seconds - self.mean)

    def note_begun(self, seconds: float) -> None:
        """Note what a request has taken so far: it may be long until the first is done."""
        self.note_whole(max(seconds, self.mean))

    def seconds(self, requests: int) -> float:
        """How long so many requests take, with the rests between them."""
        return requests * self.mean * (1.0 if self.number == 0 else 1.0 + REST)


class _Lane:
    """Small answers of one kind: those given since the sockets were looked at, those that wait."""

    def __init__(self) -> None:
        self.given = 0
        self.waiting: deque[asyncio.Future[None]] = deque()


class FairAdmission:
    """Lets whole requests through to the application one by one, in turn by client."""

    def __init__(self, app: ASGIApp, measure: Callable[[], float] = unit) -> None:
        self.app = app
        self._costs = Costs(measure)
        self._classes = [_Class(number) for number in range(CLASSES)]
        self._ordinary = self._classes[0]
        # The time of the loop at which an ordinary request came.
        self._ordinary_came = float("-inf")
        self._alarm: asyncio.TimerHandle | None = None
        # Processor time since the sockets were looked at; whether they will be.
        self._spent = 0.0
        self._looking = False
        # Of their own each: a thousand refusals must not make a question about health wait.
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

        def gone() -> bool:
            return ended and _gone(receive)

        host, port = scope.get("client") or ("", 0)
        ticket = Ticket(scope.get(CLIENT) or client_key(host), port, len(body))
        place = self._class(ticket)
        if self._others_first(place):
            refusal = self._refusal(ticket)
            if refusal is not None:
                body = b""
                await self._small_turn(self._refusals)
                await refusal.response(scope["path"])(scope, receive, send)
                return
            try:
                place = await self._turn(ticket, gone)
            except ClientDisconnect:
                return
        place.queue.begin(ticket)
        charged = Spent(0.0, 0.0)

        async def turn() -> None:
            nonlocal charged, place
            self._charge(place, ticket, metered.spent.since(charged))
            charged = metered.spent
            place.note_begun(charged.work)
            place = self._class(ticket)
            if self._others_first(place):
                place = await self._turn(ticket, gone)
            place.queue.begin(ticket)

        inner = {**scope, TURN: turn}
        metered = Metered(self.app(inner, _again(body, ended, receive), send))
        try:
            await metered
        finally:
            self._charge(place, ticket, metered.spent.since(charged))
            place.note_whole(metered.spent.work)

    @property
    def waiting(self) -> int:
        """How many requests wait for their turn."""
        return sum(len(each.queue) for each in self._classes)

    def _class(self, ticket: Ticket) -> _Class:
        """The class of a request that has come."""
        number = self._costs.class_of(self._costs.expected(ticket))
        if number == 0:
            self._ordinary_came = asyncio.get_running_loop().time()
        return self._classes[number]

    def _others_first(self, place: _Class) -> bool:
        """Whether others wait, or have to be heard first."""
        return len(self._ordinary.queue) > 0 or self._spent >= SLICE or place is not self._ordinary

    def _charge(self, place: _Class, ticket: Ticket, spent: Spent) -> None:
        """Charge what a request, or one of its gradings, has taken."""
        seconds = spent.work
        self._spent += seconds
        self._look_soon()
        place.queue.charge(ticket, seconds)
        self._costs.note(ticket, seconds)
        if number := max(place.number, self._costs.class_of(seconds)):
            now = asyncio.get_running_loop().time()
            for each in self._classes[1:]:
                steps = abs(each.number - number)
                each.ready = max(each.ready, now + rest(spent.elapsed, steps))

    def _refusal(self, ticket: Ticket) -> ProblemError | None:
        """The problem of a request for which there is no place in the queues, or None."""
        queues = [each.queue for each in self._classes]
        requests, sizes = zip(*(queue.of(ticket.client) for queue in queues), strict=True)
        if sum(requests) >= OF_ONE[0] or sum(sizes) + ticket.size > OF_ONE[1]:
            return too_many(self._seconds(requests))
        requests = tuple(map(len, queues))
        if sum(requests) >= OF_ALL[0] or sum(q.size for q in queues) + ticket.size > OF_ALL[1]:
            return too_busy(self._seconds(requests))
        return None

    def _seconds(self, requests: Iterable[int]) -> int:
        """When to come again, where so many of each class wait."""
        work = sum(map(_Class.seconds, self._classes, requests))
        return min(max(1, math.ceil(work)), _LONGEST_RETRY)

    async def _turn(self, ticket: Ticket, gone: Callable[[], bool]) -> _Class:
        """Wait until it is this request's turn and there is time; its class then.

        Raises ClientDisconnect where the client has gone meanwhile.
        """
        before = None
        while True:
            # Others like it may have been costly meanwhile.
            place = self._class(ticket)
            ticket.turn = asyncio.get_running_loop().create_future()
            place.queue.push(ticket, again=place is before)
            self._look_soon()
            try:
                await ticket.turn
            except asyncio.CancelledError:
                # At the end of the process, when all have been hung up on.
                if gone():
                    raise ClientDisconnect from None
                raise
            if gone():
                raise ClientDisconnect
            if self._spent < SLICE and (place.number or place is self._class(ticket)):
                return place
            before = place

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
            while len(self._ordinary.queue) and called < _CALLED:
                called += _wake(self._ordinary.queue.pop().turn)
        for lane in (self._health, self._refusals):
            lane.given = 0
            while lane.waiting and lane.given < SMALL:
                lane.given += _wake(lane.waiting.popleft())
            called += lane.given
        if called:
            self._look_soon()

    def _call_costly(self) -> int:
        """Call up a costly request if its time has come; how many are called up."""
        now = asyncio.get_running_loop().time()
        calm = float("inf") if len(self._ordinary.queue) else self._ordinary_came + _CALM
        times = []
        for each in self._classes[1:]:
            while len(each.queue):
                if min(each.ready, calm) > now:
                    times.append(min(each.ready, calm))
                    break
                if _wake(each.queue.pop().turn):
                    return 1
        if times:
            self._ring_at(min(times))
        return 0

    def _ring_at(self, time: float) -> None:
        """Look at the costly requests again at that time, if not before."""
        if self._alarm is not None:
            if self._alarm.when() <= time:
                return
            self._alarm.cancel()
        self._alarm = asyncio.get_running_loop().call_at(time, self._ring)

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
