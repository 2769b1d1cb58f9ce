"""The queue of the requests that wait, in which all connections have equal shares.

Start-time fair queueing (Goyal, Vin and Cheng, 1996) between connections: the next one is always
the one that has used the least processor time. An address may be that of a whole class, so each of
its connections has a share of its own; but together they have a limited number of shares.
"""

import heapq
from collections import deque
from dataclasses import dataclass, field
from typing import Any, Final

from service.api.turns import Client
from service.time_slices import SLICE

# Seconds that a step of a request counts at least: about what HTTP takes around it.
LEAST: Final = 0.0003
# Seconds that a connection may have used less than others and still make up for it: an answer that
# takes long to explain need not wait for clients that send one request after the other.
CREDIT: Final = 0.1
# The number of accounts that are kept of connections without a request.
_ACCOUNTS: Final = 1000


@dataclass(eq=False, slots=True)
class Ticket:
    """One request that waits, or is being answered, and the future that it waits for.

    ``connection`` is 0 if the connections of the client are not told apart.
    """

    client: Client
    connection: int
    size: int
    turn: Any = None

    @property
    def key(self) -> tuple[str, int]:
        """The account that is charged."""
        return self.client.name, self.connection


@dataclass(slots=True)
class _Requests:
    """The requests of one client: all that are here, and those that wait, with their bytes."""

    present: int = 0
    waiting: int = 0
    size: int = 0


@dataclass(slots=True)
class _Account:
    """The time that a connection has used, its requests, and those of them that wait."""

    used: float
    present: int = 0
    queue: deque[Ticket] = field(default_factory=deque)


class FairQueue:
    """The requests that are here, and the order of those that wait.

    Times are on a scale that goes on with the time that all have used: a connection that was away
    has a small credit, and a new one has none.
    """

    def __init__(self) -> None:
        self._now = 0.0
        self._accounts: dict[tuple[str, int], _Account] = {}
        self._clients: dict[str, _Requests] = {}
        # The connections that wait: the time used when last looked at, and the order of coming.
        self._order: list[tuple[float, int, _Account]] = []
        self._came = 0
        # The number of requests that wait, and their bytes.
        self.length = 0
        self.size = 0

    def waiting(self, client: Client) -> tuple[int, int]:
        """Return the number of requests of a client that wait, and their bytes."""
        requests = self._clients.get(client.name)
        return (requests.waiting, requests.size) if requests else (0, 0)

    def enter(self, ticket: Ticket) -> None:
        """Note that a request has come."""
        requests = self._clients.setdefault(ticket.client.name, _Requests())
        # Of many new connections that come at once, one for each share of a client is first.
        later = SLICE * requests.waiting / ticket.client.most_shares
        account = self._accounts.pop(ticket.key, None) or _Account(self._now + later)
        # The latest at the end.
        self._accounts[ticket.key] = account
        account.used = max(account.used, self._now - CREDIT)
        account.present += 1
        requests.present += 1
        if len(self._accounts) > 2 * _ACCOUNTS:
            idle = [key for key, each in self._accounts.items() if not each.present]
            for key in idle[:-_ACCOUNTS]:
                del self._accounts[key]

    def leave(self, ticket: Ticket) -> None:
        """Note that a request has been answered, or given up."""
        self._accounts[ticket.key].present -= 1
        requests = self._clients[ticket.client.name]
        requests.present -= 1
        if not requests.present:
            del self._clients[ticket.client.name]

    def push(self, ticket: Ticket) -> None:
        """Let a request wait that has come."""
        account = self._accounts[ticket.key]
        if not account.queue:
            self._wait(account)
        account.queue.append(ticket)
        self._count(ticket, 1)

    def pop(self) -> Ticket:
        """Take the request whose turn it is. Raises IndexError if none waits."""
        while True:
            used, came, account = heapq.heappop(self._order)
            if not account.queue:
                continue
            if account.used <= used:
                break
            # It was charged meanwhile.
            heapq.heappush(self._order, (account.used, came, account))
        ticket = account.queue.popleft()
        if account.queue:
            self._wait(account)
        self._count(ticket, -1)
        return ticket

    def remove(self, ticket: Ticket) -> None:
        """Let a request wait no longer that is given up."""
        queue = self._accounts[ticket.key].queue
        if ticket in queue:
            queue.remove(ticket)
            self._count(ticket, -1)

    def begin(self, ticket: Ticket) -> None:
        """Note that a request has its turn."""
        self._now = max(self._now, self._accounts[ticket.key].used)

    def charge(self, ticket: Ticket, seconds: float) -> None:
        """Charge the processor time that a step of a request took."""
        account = self._accounts[ticket.key]
        # A client beyond its shares pays more; the requests of one account share the cost.
        excess = max(1.0, self._clients[ticket.client.name].present / ticket.client.most_shares)
        account.used += max(LEAST, seconds) * excess / account.present
        # By half of a fair share: so no request waits for ever for connections that are all new.
        self._now += seconds / (2 + 2 * len(self._order))

    def _wait(self, account: _Account) -> None:
        self._came += 1
        heapq.heappush(self._order, (account.used, self._came, account))

    def _count(self, ticket: Ticket, sign: int) -> None:
        requests = self._clients[ticket.client.name]
        requests.waiting += sign
        requests.size += sign * ticket.size
        self.length += sign
        self.size += sign * ticket.size
