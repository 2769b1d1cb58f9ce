"""Who is next, of the requests that wait.

Start-time fair queueing (Goyal, Vin and Cheng, 1996) between clients, and below each client between
its connections: always the one that has had the least. What it has had is the processor time of its
requests, and a request that takes long weighs more than its time: whoever sends costly ones leaves
room for hundreds of small ones between any two.
"""

from collections import deque
from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field
from typing import Any, Final

# Seconds of processor time. A request that takes longer weighs more, by as many times as it does.
LIGHT: Final = 0.005
# What any request weighs at least: so clients of small ones come in turn, too.
LEAST: Final = 0.0001
# The weight of the heaviest, so that nobody waits for ever: one second of each of the others.
HEAVIEST: Final = 1.0
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


def weight(seconds: float) -> float:
    """What a request counts that took so much processor time."""
    return min(max(LEAST, seconds, seconds**2 / LIGHT), HEAVIEST)


@dataclass(slots=True)
class _Accounts:
    """What each has had, on a scale that runs on with what everybody has."""

    now: float = 0.0
    spent: dict[Hashable, float] = field(default_factory=dict)

    def start(self, key: Hashable) -> float:
        return max(self.now, self.spent.get(key, 0.0))

    def owed(self, key: Hashable) -> float:
        return self.spent.get(key, 0.0) - self.now

    def least(self, keys: Iterable[Any]) -> Any:
        """Of these, the one that has had the least; of equals the first."""
        return min(keys, key=self.start)

    def begin(self, key: Hashable) -> None:
        """Note that somebody's request is begun: nobody who waits has had less."""
        self.now = self.start(key)

    def charge(self, key: Hashable, amount: float) -> None:
        """Add to what somebody has had."""
        self.spent[key] = min(self.start(key) + amount, self.now + HEAVIEST)
        if len(self.spent) > _ACCOUNTS:
            # Those who have had no more than everybody need no account.
            owing = sorted(self.spent.items(), key=lambda item: item[1])[_ACCOUNTS // 2 :]
            self.spent = dict(owing)


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
        queues = self._waiting.setdefault(ticket.client, {})
        queue = queues.setdefault(ticket.connection, deque())
        if again:
            queue.appendleft(ticket)
        else:
            queue.append(ticket)
        self._note(ticket, 1)

    def next(self) -> Ticket:
        """The request whose turn it is. Raises ValueError where none waits."""
        client = self._clients.least(self._waiting)
        queues = self._waiting[client]
        return queues[self._accounts(client).least(queues)][0]

    def pop(self) -> Ticket:
        """Take the request whose turn it is. Raises ValueError where none waits.

        It counts as the least that there is, so that several are taken in turn.
        """
        ticket = self.next()
        client, connection = ticket.client, ticket.connection
        queues = self._waiting[client]
        queues[connection].popleft()
        if not queues[connection]:
            del queues[connection]
        if not queues:
            del self._waiting[client]
        self._note(ticket, -1)
        self.charge(ticket, LEAST)
        return ticket

    def owing(self, ticket: Ticket) -> bool:
        """Whether a request is of somebody who has had more than others, by more than a little."""
        accounts = self._accounts(ticket.client)
        return self._clients.owed(ticket.client) > LIGHT or accounts.owed(ticket.connection) > LIGHT

    def begin(self, ticket: Ticket) -> None:
        """Note that a request is begun: nobody who waits has had less."""
        self._clients.begin(ticket.client)
        self._accounts(ticket.client).begin(ticket.connection)

    def charge(self, ticket: Ticket, seconds: float) -> None:
        """Charge the processor time that a request took."""
        self._clients.charge(ticket.client, weight(seconds))
        self._accounts(ticket.client).charge(ticket.connection, weight(seconds))

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
