"""The open connections of one process, with limits for their number and their bytes.

Beyond a limit, the process closes connections that have no complete request.
"""

import asyncio
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final, Protocol

from service.server.limits import MAX_CONNECTIONS, MAX_UNFINISHED, OTHER_FILES, RESERVE, SWEEP

# One connection in 16 is closed at once, so that choosing them costs little for each.
_CLOSED_SHARE: Final = 16


class OpenConnection(Protocol):
    """The interface of a connection that ``OpenConnections`` uses."""

    address: str
    # The time of the event loop at which the connection expires.
    deadline: float
    # The time since which it waits for its client; None while a request is being answered.
    waiting_since: float | None
    # Bytes of an unfinished request and of unread answers.
    unfinished: int

    def expire(self) -> None:
        """Close the connection because its time limit has passed."""

    def reset(self) -> None:
        """Close the connection at once."""


@dataclass(frozen=True, slots=True)
class ConnectionLimits:
    """The largest number of connections, and of bytes in their unfinished requests."""

    connections: int = MAX_CONNECTIONS
    unfinished: int = MAX_UNFINISHED


class OpenConnections:
    """The connections of one process."""

    def __init__(self, limits: ConnectionLimits) -> None:
        self._limits = limits
        self._connections: dict[OpenConnection, None] = {}
        self._unfinished = 0
        self._sweeping: asyncio.TimerHandle | None = None

    def __len__(self) -> int:
        """The number of connections."""
        return len(self._connections)

    @property
    def full(self) -> bool:
        """True if there are too many connections."""
        # The service then answers only health checks.
        return len(self._connections) > self._limits.connections

    def enter(self, connection: OpenConnection, loop: asyncio.AbstractEventLoop) -> bool:
        """Add a connection; return False if there are too many."""
        # Waiting connections are closed first.
        if len(self._connections) >= self._limits.connections:
            self._close_waiting(_one, 1 + self._limits.connections // _CLOSED_SHARE)
        if len(self._connections) >= self._limits.connections + RESERVE:
            return False
        self._connections[connection] = None
        if self._sweeping is None:
            self._sweeping = loop.call_later(SWEEP, self._sweep, loop)
        return True

    def leave(self, connection: OpenConnection) -> None:
        """Remove a connection."""
        if connection in self._connections:
            del self._connections[connection]
            self._unfinished -= connection.unfinished
            connection.unfinished = 0

    def set_unfinished(self, connection: OpenConnection, size: int) -> None:
        """Set the size of a connection's unfinished request; limit the sum of all sizes."""
        if connection not in self._connections:
            return
        self._unfinished += size - connection.unfinished
        connection.unfinished = size
        if self._unfinished > self._limits.unfinished:
            excess = self._unfinished - self._limits.unfinished
            self._close_waiting(_bytes, excess + self._limits.unfinished // 4)

    def _close_waiting(self, weight: Callable[[OpenConnection], int], wanted: int) -> None:
        waiting = [
            each for each in self._connections if each.waiting_since is not None and weight(each)
        ]
        shares: Counter[str] = Counter()
        for connection in waiting:
            shares[connection.address] += weight(connection)
        for connection in closing_order(waiting, shares, weight):
            if wanted <= 0:
                break
            wanted -= weight(connection)
            self.leave(connection)
            connection.reset()

    def _sweep(self, loop: asyncio.AbstractEventLoop) -> None:
        now = loop.time()
        for connection in [each for each in self._connections if each.deadline < now]:
            connection.expire()
        self._sweeping = loop.call_later(SWEEP, self._sweep, loop) if self._connections else None


def _one(_: OpenConnection) -> int:
    return 1


def _bytes(connection: OpenConnection) -> int:
    return connection.unfinished


def closing_order(
    waiting: Iterable[OpenConnection], shares: Counter[str], weight: Callable[[OpenConnection], int]
) -> Iterable[OpenConnection]:
    """Yield waiting connections in the order in which to close them.

    The address with the most connections or bytes comes first.
    """
    queues: dict[str, list[OpenConnection]] = {}
    for connection in sorted(waiting, key=lambda each: each.waiting_since or 0.0, reverse=True):
        queues.setdefault(connection.address, []).append(connection)
    while queues:
        address = max(queues, key=shares.__getitem__)
        connection = queues[address].pop()
        shares[address] -= weight(connection)
        if not queues[address]:
            del queues[address]
        yield connection


def allowed_here() -> ConnectionLimits:
    """Raise the limit of open files, and return the connection limits that result from it."""
    try:
        import resource
    except ImportError:  # Windows, which has no such limit
        return ConnectionLimits()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = MAX_CONNECTIONS + RESERVE + OTHER_FILES
    if soft != resource.RLIM_INFINITY and soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
        return ConnectionLimits(
            connections=max(1, min(MAX_CONNECTIONS, soft - RESERVE - OTHER_FILES))
        )
    return ConnectionLimits()
