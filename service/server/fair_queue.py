"""Who is next, of the requests that wait.

Start-time fair queueing (Goyal, Vin and Cheng, 1996) between clients, and below each client between
its connections: always the one that has had the least processor time.
"""

import heapq
from collections import deque
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Any, Final

# What any request counts at least, in seconds of processor time: so clients of small ones come in
# turn, too.
LEAST: Final = 0.0001
# How many accounts are kept of those who do not wait.
_ACCOUNTS: Final = 1000


@dataclass(eq=False, slots=True)
class Ticket:
    """One request that waits, or is being answered."""

    client: str
    connection: Hashable
    size: int
    # What the waiting request waits for.
    turn: Any = None


class _Accounts:
    """What each has had, on a scale that runs on with what everybody has, and who waits."""

    def __init__(self) -> None:
        self.spent: dict[Hashable, float] = {}
        self._now = 0.0
        # What those had who wait, when last looked at, in the order of their coming.
        self._tags: list[tuple[float, int, Any]] = []
        self._came = 0

    def _start(self, key: Hashable) -> float:
        return max(self._now, self.spent.get(key, 0.0))

    def wait(self, key: Hashable) -> None:
        """Let somebody wait who does not yet."""
        self._came += 1
        heapq.heappush(self._tags, (self._start(key), self._came, key))

    def least(self) -> Any:
        """Of those who wait, the one that has had the least. Raises IndexError where none waits."""
        while True:
            tag, came, key = self._tags[0]
            spent = self.spent.get(key, 0.0)
            if spent <= tag:
                return key
            # Something was charged meanwhile.
            heapq.heapreplace(self._tags, (spent, came, key))

    def leave(self) -> None:
        """Let the one that has had the least wait no more."""
        heapq.heappop(self._tags)

    def begin(self, key: Hashable) -> None:
        """Note that somebody's request is begun: nobody who waits has had less."""
        self._now = self._start(key)

    def charge(self, key: Hashable, seconds: float) -> None:
        """Add to what somebody has had."""
        self.spent[key] = self._start(key) + max(LEAST, seconds)
        if len(self.spent) > _ACCOUNTS:
            # Those who have had no more than everybody need no account.
            most = sorted(self.spent.items(), key=lambda item: item[1])[_ACCOUNTS // 2 :]
            self.spent = dict(most)


class FairQueue:
    """The requests that wait."""

    def __init__(self) -> None:
        self._waiting: dict[str, dict[Hashable, deque[Ticket]]] = {}
        self._clients = _Accounts()
        self._connections: dict[str, _Accounts] = {}
        self._count: dict[str, int] = {}
        self._bytes: dict[str, int] = {}
        self._length = 0
        # How many bytes the requests have that wait.
        self.size = 0

    def __len__(self) -> int:
        """How many requests wait."""
        return self._length

    def of(self, client: str) -> tuple[int, int]:
        """How many requests of a client wait, and how many bytes they have."""
        return self._count.get(client, 0), self._bytes.get(client, 0)

    def push(self, ticket: Ticket, *, again: bool = False) -> None:
        """Let a request wait; ``again`` where it had its turn and found no time."""
        if ticket.client not in self._waiting:
            self._waiting[ticket.client] = {}
            self._clients.wait(ticket.client)
        queues = self._waiting[ticket.client]
        if ticket.connection not in queues:
            queues[ticket.connection] = deque()
            self._accounts(ticket.client).wait(ticket.connection)
        if again:
            queues[ticket.connection].appendleft(ticket)
        else:
            queues[ticket.connection].append(ticket)
        self._note(ticket, 1)

    def next(self) -> Ticket:
        """The request whose turn it is. Raises IndexError where none waits."""
        client = self._clients.least()
        return self._waiting[client][self._accounts(client).least()][0]

    def pop(self) -> Ticket:
        """Take the request whose turn it is. Raises IndexError where none waits.

        It counts as the least that there is, so that several are taken in turn.
        """
        ticket = self.next()
        client, connection = ticket.client, ticket.connection
        queues, accounts = self._waiting[client], self._accounts(client)
        queues[connection].popleft()
        self._clients.leave()
        accounts.leave()
        self.charge(ticket, LEAST)
        if queues[connection]:
            accounts.wait(connection)
        else:
            del queues[connection]
        if queues:
            self._clients.wait(client)
        else:
            del self._waiting[client]
        self._note(ticket, -1)
        return ticket

    def begin(self, ticket: Ticket) -> None:
        """Note that a request is begun: nobody who waits has had less."""
        self._clients.begin(ticket.client)
        self._accounts(ticket.client).begin(ticket.connection)

    def charge(self, ticket: Ticket, seconds: float) -> None:
        """Charge the processor time that a request took."""
        self._clients.charge(ticket.client, seconds)
        self._accounts(ticket.client).charge(ticket.connection, seconds)

    def _accounts(self, client: str) -> _Accounts:
        found = self._connections.get(client)
        if found is None:
            if len(self._connections) > _ACCOUNTS:
                kept = self._waiting.keys()
                self._connections = {c: a for c, a in self._connections.items() if c in kept}
            found = self._connections[client] = _Accounts()
        return found

    def _note(self, ticket: Ticket, sign: int) -> None:
        self._length += sign
        self.size += sign * ticket.size
        self._count[ticket.client] = self._count.get(ticket.client, 0) + sign
        self._bytes[ticket.client] = self._bytes.get(ticket.client, 0) + sign * ticket.size
        if not self._count[ticket.client]:
            del self._count[ticket.client], self._bytes[ticket.client]
