"""The queue of waiting requests, in which connections share the processor equally.

The next request belongs to the connection that has used the least processor time. The method is
start-time fair queueing (Goyal, Vin and Cheng, 1996).
"""

# A whole class may share one address, so each connection of an address has a share of its own; but
# the shares of one address are limited. If all requests took turns after each slice, a request ten
# times as long as the mean would wait for all the others ten times. So each connection has an
# allowance: time within it is charged only when the connection's next request comes. Thus ordinary
# requests run in the order of their arrival. Connections that send one costly request after the
# other use up their allowance.

from collections import deque
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, Final

from service.api.turns import Client
from service.time_slices import SLICE

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
    """One request that waits or is being answered; the request awaits the future ``turn``."""

    # ``connection`` is 0 if the connections of the client cannot be distinguished.

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
        """Add a request to the queue."""
        # Call ``enter`` before.
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
