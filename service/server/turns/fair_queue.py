"""The queue of the requests that wait, in which all connections have equal shares.

Start-time fair queueing (Goyal, Vin and Cheng, 1996) between connections: the next request is one
of the connection that has used the least processor time. An address may be that of a whole class,
so each of its connections has a share of its own; but together they have a limited number.

If all take turns after each slice, a request that takes ten times as long as the mean waits for all
the others ten times. So what a request uses counts later if the connection has an allowance for it:
ordinary requests run in the order in which they came. Connections that send costly requests one
after the other have no allowance.
"""

from collections import deque
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, Final

from service.api.turns import Client
from service.time_slices import SLICE

# Seconds that a step of a request counts at least: about what HTTP takes around it.
LEAST: Final = 0.0003
# Seconds that a connection may have used less than others and still make up for it: an answer that
# takes long to explain need not wait for clients that send one request after the other.
CREDIT: Final = 0.1
# Seconds that a connection may have used more than others when its next request comes; what is
# beyond that is forgiven.
DEBT: Final = SLICE
# The share of a connection's fair share that gives no credit. Below 1, connections that are always
# busy have none and are served in the order of their requests; above 0, no request waits for ever.
PACE: Final = 0.6
# Seconds of a request that count only at the next one: of the first request; what each later one
# adds, about twice the mean; and the most that a connection can save, or owe.
FIRST, ALLOWANCE, SAVED = 0.006, 0.016, 0.1
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
    """The time that a connection has used, its requests, and those of them that wait.

    ``spent`` is the time of its last request, of which ``allowed`` did not count in ``used``, and
    ``excess`` how many times as much it pays.
    """

    used: float
    allowed: float = FIRST
    spent: float = 0.0
    excess: float = 1.0
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
        # The connections of which a request waits.
        self._waiting: dict[tuple[str, int], _Account] = {}
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
        requests.present += 1
        account = self._accounts.pop(ticket.key, None)
        if account is None:
            # Of many new connections that come at once, one for each share of a client is first.
            later = SLICE * requests.waiting / ticket.client.most_shares
            account = _Account(self._now + later)
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
        """Charge what did not count in the last request, and give an allowance for the next."""
        due = min(account.spent, max(0.0, account.allowed))
        used = max(account.used + due * account.excess, self._now - CREDIT)
        account.used = min(used, self._now + DEBT * account.excess)
        account.allowed = min(max(account.allowed - account.spent, -SAVED) + ALLOWANCE, SAVED)
        account.spent = 0.0

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
        account.queue.append(ticket)
        self._waiting[ticket.key] = account
        self._count(ticket, 1)

    def pop(self) -> Ticket:
        """Take the request whose turn it is. Raises ValueError if none waits."""
        account = min(self._waiting.values(), key=attrgetter("used"))
        ticket = account.queue[0]
        self.remove(ticket)
        return ticket

    def remove(self, ticket: Ticket) -> None:
        """Let a request wait no longer, because it has its turn or is given up."""
        queue = self._accounts[ticket.key].queue
        if ticket in queue:
            queue.remove(ticket)
            self._count(ticket, -1)
            if not queue:
                del self._waiting[ticket.key]

    def charge(self, ticket: Ticket, seconds: float) -> None:
        """Charge the processor time that a step of a request took."""
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
