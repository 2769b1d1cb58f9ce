"""Balance the connections of a shared port between worker processes.

A worker that has more connections than another pauses for a moment, so that the other accepts some.
"""

# The system wakes all workers, and the first one awake would accept all waiting connections.

import asyncio
import multiprocessing
import socket
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

# The number of connections of a process that does not listen.
_AWAY: Final = 2**31 - 1
# A worker with n connections more than another one pauses if n is at least _MORE plus one for each
# _PER connections of the other.
_MORE: Final = 1
_PER: Final = 8
# Seconds of this pause; after it the worker accepts a connection, because the other one is busy.
_MOMENT: Final = 0.005
# Seconds until the next attempt if no connection can be opened.
_PAUSE: Final = 1.0
# How many connections the system queues until they are accepted.
_BACKLOG: Final = 2048
# How many connections are accepted before the accepted ones are read.
_AT_ONCE: Final = 32


@dataclass(frozen=True)
class ConnectionCounts:
    """The number of connections of each process, in shared memory."""

    # An array of the C type int.
    numbers: Any

    @classmethod
    def of(cls, number: int) -> "ConnectionCounts":
        """Return new counts for ``number`` processes."""
        return cls(multiprocessing.get_context("spawn").RawArray("i", [_AWAY] * number))

    @property
    def any_listening(self) -> bool:
        """True if at least one process listens."""
        return any(count != _AWAY for count in self.numbers)

    def stop_listening(self, index: int) -> None:
        """Record that the process with this index no longer accepts connections."""
        self.numbers[index] = _AWAY


@dataclass(frozen=True)
class SharedPort:
    """A port that several workers share, and the index of this worker."""

    listener: socket.socket
    counts: ConnectionCounts
    index: int
    # The process id of the supervisor.
    supervisor: int


class Acceptor:
    """Accepts connections from a shared port, about as many as other processes do."""

    def __init__(
        self,
        port: SharedPort,
        connections: Callable[[], int],
        protocol: Callable[[], asyncio.Protocol],
    ) -> None:
        self._port = port
        self._connections = connections
        self._protocol = protocol
        self._loop = asyncio.get_running_loop()
        self._waiting: asyncio.TimerHandle | None = None
        self._tasks: set[asyncio.Task[Any]] = set()
        port.listener.setblocking(False)
        port.listener.listen(_BACKLOG)
        self._listen()

    def close(self) -> None:
        """Stop accepting connections."""
        self._loop.remove_reader(self._port.listener)
        self._port.listener.close()
        if self._waiting is not None:
            self._waiting.cancel()
        self._port.counts.stop_listening(self._port.index)

    def publish_count(self) -> int:
        """Publish this worker's number of connections; return the smallest one of other workers."""
        here, counts = self._port.index, self._port.counts.numbers
        counts[here] = self._count()
        return min((n for index, n in enumerate(counts) if index != here), default=_AWAY)

    def _count(self) -> int:
        return self._connections() + len(self._tasks)

    def _listen(self) -> None:
        self.publish_count()
        self._loop.add_reader(self._port.listener, self._accept_some)

    def _has_more(self) -> bool:
        least = self.publish_count()
        return self._count() >= least + _MORE + least // _PER

    def _accept_some(self) -> None:
        for _ in range(_AT_ONCE):
            if self._has_more():
                self._wait(_MOMENT)
                return
            if not self._accept():
                return

    def _accept(self) -> bool:
        try:
            connection, _ = self._port.listener.accept()
        except (BlockingIOError, InterruptedError, ConnectionAbortedError):
            return False
        except OSError:
            self._wait(_PAUSE)
            return False
        connection.setblocking(False)
        opening = self._loop.connect_accepted_socket(self._protocol, connection)
        task = self._loop.create_task(opening)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return True

    def _wait(self, seconds: float) -> None:
        self._loop.remove_reader(self._port.listener)
        self._waiting = self._loop.call_later(seconds, self._resume)

    def _resume(self) -> None:
        self._waiting = None
        self._accept()
        if self._waiting is None:
            self._listen()
