"""Fair turns between the requests of clients, in slices of a few milliseconds.

``FairAdmission`` is the middleware, and ``FairQueue`` decides whose turn it is. Which client a
request belongs to is decided by ``access``, and how work is cut into slices by ``slices``.
"""

import asyncio
import math
from collections import deque
from collections.abc import Awaitable, Callable, Generator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import partial
from operator import attrgetter
from statistics import median
from time import thread_time
from typing import Any, Final

import numpy as np
from starlette.requests import ClientDisconnect, HTTPConnection
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from dh_grader.access import client_key
from dh_grader.api.http import ARRIVED, CLIENT, ONE_ADDRESS, TURN, Client, ProblemError, language_of
from dh_grader.kinematics import Convention, pose
from dh_grader.server.connections import HEALTH, too_busy, too_many
from dh_grader.slices import SLICE
from dh_grader.submissions.bodies import MAX_BODY_SIZE

# --- Schedule the requests of clients fairly, in time slices of a few milliseconds
#
# After each slice, the connection that has used the least processor time may continue.
#
# Small requests share a slice, because reading the sockets costs as much as answering one of them.


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

    async def _serve(self, ticket: "Ticket", scope: Scope, body: "_Replayed", send: Send) -> None:
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

    def _charge(self, ticket: "Ticket", seconds: float) -> None:
        self._spent += seconds
        self._queue.charge(ticket, seconds)
        self._read_soon()

    def _refusal(self, ticket: "Ticket") -> ProblemError | None:
        requests, size = self._queue.waiting(ticket.client)
        is_beyond = requests >= OF_ONE[0] or size + ticket.size > OF_ONE[1]
        if is_beyond and not ticket.client.is_trusted:
            return too_many(self._seconds(requests))
        if self._queue.length >= OF_ALL[0] or self._queue.size + ticket.size > OF_ALL[1]:
            return too_busy(self._seconds(self._queue.length))
        return None

    def _seconds(self, requests: int) -> int:
        return min(max(1, math.ceil(requests * self._mean)), _LONGEST_RETRY)

    async def _turn(self, ticket: "Ticket", body: "_Replayed") -> None:
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


# --- The queue of waiting requests, in which connections share the processor equally
#
# The next request belongs to the connection that has used the least processor time. The method is
# start-time fair queueing (Goyal, Vin and Cheng, 1996).
#
# A whole class may share one address, so each connection of an address has a share of its own; but
# the shares of one address are limited. If all requests took turns after each slice, a request ten
# times as long as the mean would wait for all the others ten times. So each connection has an
# allowance: time within it is charged only when the connection's next request comes. Thus ordinary
# requests run in the order of their arrival. Connections that send one costly request after the
# other use up their allowance.


# The least number of seconds charged for a step of a request: about the cost of HTTP.
LEAST: Final = 0.0003
# The most seconds of unused share that a connection may use later: so a costly answer need not wait
# for clients that send one request after the other.
CREDIT: Final = 0.1
# The most seconds above its share that a connection still owes when its next request comes; the
# rest is forgiven.
DEBT: Final = SLICE
# How fast the common clock runs, compared with the fair share of a connection. Below 1, connections
# that are always busy get no credit and are served in the order of their requests; above 0, no
# request waits for ever.
PACE: Final = 0.4
# Allowances, as multiples of the time of an ordinary request: of the first request; what each later
# request adds; and the most that a connection can save, or owe.
FIRST, ALLOWANCE, SAVED = 1.0, 2.0, 9.0
# The number of accounts kept for connections that have no request.
_ACCOUNTS: Final = 1000


@dataclass(eq=False, slots=True)
class Ticket:
    """One request that waits or is being answered; the request awaits the future ``turn``.

    ``connection`` is 0 if the connections of the client cannot be distinguished.
    """

    client: Client
    connection: int
    size: int
    turn: Any = None

    @property
    def key(self) -> tuple[str, int]:
        """The key of the account to which processor time is charged."""
        return self.client.name, self.connection


@dataclass(slots=True)
class _Requests:
    present: int = 0
    waiting: int = 0
    size: int = 0


@dataclass(slots=True)
class _Account:
    # ``spent`` is the time of the last request; up to ``allowed`` seconds of this time are not yet
    # charged to ``used``. Charged time is multiplied by ``excess``.
    used: float
    allowed: float
    spent: float = 0.0
    excess: float = 1.0
    present: int = 0
    queue: deque[Ticket] = field(default_factory=deque)


class FairQueue:
    """The requests of all connections, and the processor time that the connections have used.

    ``ordinary`` is the time in seconds of an ordinary request on this machine.
    """

    # Times are on a common clock that advances with the time that all connections use. A connection
    # that was idle has a small credit, and a new connection has none.

    def __init__(self, ordinary: float) -> None:
        self.ordinary = ordinary
        self._now = 0.0
        self._accounts: dict[tuple[str, int], _Account] = {}
        self._clients: dict[str, _Requests] = {}
        # The accounts of connections with a waiting request.
        self._waiting: dict[tuple[str, int], _Account] = {}
        # The number of waiting requests, and their bytes.
        self.length = 0
        self.size = 0

    def waiting(self, client: Client) -> tuple[int, int]:
        """Return the number of waiting requests of a client, and their bytes."""
        requests = self._clients.get(client.name)
        return (requests.waiting, requests.size) if requests else (0, 0)

    def enter(self, ticket: Ticket) -> None:
        """Note that a request has arrived."""
        requests = self._clients.setdefault(ticket.client.name, _Requests())
        requests.present += 1
        account = self._accounts.pop(ticket.key, None)
        if account is None:
            # Many new connections of a client that come at once start one after the other, as many
            # at a time as the client has shares.
            later = SLICE * requests.waiting / ticket.client.most_shares
            account = _Account(self._now + later, FIRST * self.ordinary)
        elif not account.present:
            self._settle(account)
        # The latest at the end.
        self._accounts[ticket.key] = account
        account.present += 1
        if len(self._accounts) > 2 * _ACCOUNTS:
            idle = [key for key, each in self._accounts.items() if not each.present]
            for key in idle[:-_ACCOUNTS]:
                del self._accounts[key]

    def _settle(self, account: _Account) -> None:
        due = min(account.spent, max(0.0, account.allowed))
        used = max(account.used + due * account.excess, self._now - CREDIT)
        account.used = min(used, self._now + DEBT * account.excess)
        most = SAVED * self.ordinary
        left = max(account.allowed - account.spent, -most)
        account.allowed = min(left + ALLOWANCE * self.ordinary, most)
        account.spent = 0.0

    def leave(self, ticket: Ticket) -> None:
        """Note that a request has been answered or cancelled."""
        self._accounts[ticket.key].present -= 1
        requests = self._clients[ticket.client.name]
        requests.present -= 1
        if not requests.present:
            del self._clients[ticket.client.name]

    def push(self, ticket: Ticket) -> None:
        """Add a request, which has entered, to the queue."""
        account = self._accounts[ticket.key]
        account.queue.append(ticket)
        self._waiting[ticket.key] = account
        self._count(ticket, 1)

    def pop(self) -> Ticket:
        """Remove and return the next request. Raises ValueError if none waits."""
        account = min(self._waiting.values(), key=attrgetter("used"))
        ticket = account.queue[0]
        self.remove(ticket)
        return ticket

    def remove(self, ticket: Ticket) -> None:
        """Remove a request from the queue."""
        queue = self._accounts[ticket.key].queue
        if ticket in queue:
            queue.remove(ticket)
            self._count(ticket, -1)
            if not queue:
                del self._waiting[ticket.key]

    def charge(self, ticket: Ticket, seconds: float) -> None:
        """Charge the processor time of a request's step to its connection."""
        account = self._accounts[ticket.key]
        self._now = max(self._now, account.used)
        self._now += PACE * seconds / (1 + len(self._waiting))
        # The requests of one account share the cost.
        cost = max(LEAST, seconds) / account.present
        account.spent += cost
        beyond = min(cost, account.spent - max(0.0, account.allowed))
        # A client beyond its shares pays more.
        shares = self._clients[ticket.client.name].present / ticket.client.most_shares
        account.excess = max(1.0, shares)
        account.used += max(0.0, beyond) * account.excess

    def _count(self, ticket: Ticket, sign: int) -> None:
        requests = self._clients[ticket.client.name]
        requests.waiting += sign
        requests.size += sign * ticket.size
        self.length += sign
        self.size += sign * ticket.size


# --- Measure how long an ordinary request takes on this machine
#
# The measure is the time of a fixed computation, because costly requests must not change it.


# The mean of wrong tables, in multiples of the computation.
ORDINARY: Final = 190
# The number of measurements that count, and of requests between two of them.
_KEPT, _BETWEEN = 31, 50
_LINKS: Final = np.random.default_rng(0).uniform(-1, 1, (6, 4, 64))


class Speed:
    """The time of an ordinary request: the median of the last measurements."""

    def __init__(self) -> None:
        self._measured = deque((_measured() for _ in range(_KEPT)), maxlen=_KEPT)
        self._requests = 0
        self.ordinary = ORDINARY * median(self._measured)

    def after_request(self) -> float:
        """Return the time of an ordinary request, which is measured again now and then."""
        self._requests += 1
        if self._requests % _BETWEEN == 0:
            self._measured.append(_measured())
            self.ordinary = ORDINARY * median(self._measured)
        return self.ordinary


def _measured() -> float:
    began = thread_time()
    pose(_LINKS, Convention.STANDARD)
    return thread_time() - began
