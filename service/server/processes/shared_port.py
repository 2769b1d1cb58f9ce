"""A port that several processes share: each connection goes to a process that has few.

The system wakes all of them, and the first to come would take all that wait. So one that has more
than another leaves the port alone for a moment, in which the other may take its share.
"""

import asyncio
import multiprocessing
import socket
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

# The number of connections of a process that does not listen.
_AWAY: Final = 2**31 - 1
# How many connections more than another one may have: one, and a share of what the other has.
_MORE: Final = 1
_SHARE: Final = 8
# Seconds until one that has more takes a connection all the same: the other is busy.
_MOMENT: Final = 0.005
# Seconds until the next try where no connection can be opened.
_PAUSE: Final = 1.0
# How many the system keeps until they are taken.
_BACKLOG: Final = 2048
# How many are taken until those that have come are heard.
_AT_ONCE: Final = 32


@dataclass(frozen=True)
class Seats:
    """How many connections each process has, in memory that all share."""

    # An array of the C type int.
    counts: Any

    @classmethod
    def of(cls, number: int) -> "Seats":
        """Seats of so many processes, none of which listens yet."""
        return cls(multiprocessing.get_context("spawn").RawArray("i", [_AWAY] * number))

    @property
    def any_taken(self) -> bool:
        """Whether a process listens."""
        return any(count != _AWAY for count in self.counts)

    def leave(self, place: int) -> None:
        """Note that the process of this place does not listen."""
        self.counts[place] = _AWAY


@dataclass(frozen=True)
class SharedPort:
    """A port as one of its processes has it."""

    listener: socket.socket
    seats: Seats
    place: int
    # The process that looks after this one.
    supervisor: int


class Acceptor:
    """Takes connections from a shared port, as many as other processes do."""

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
        """Take no more."""
        self._loop.remove_reader(self._port.listener)
        self._port.listener.close()
        if self._waiting is not None:
            self._waiting.cancel()
        self._port.seats.leave(self._port.place)

    def note(self) -> int:
        """Tell the others how many connections there are here; the least that another has."""
        here, counts = self._port.place, self._port.seats.counts
        counts[here] = self._count()
        return min((n for place, n in enumerate(counts) if place != here), default=_AWAY)

    def _count(self) -> int:
        return self._connections() + len(self._tasks)

    def _listen(self) -> None:
        self.note()
        self._loop.add_reader(self._port.listener, self._take_turn)

    def _has_more(self) -> bool:
        least = self.note()
        return self._count() >= least + _MORE + least // _SHARE

    def _take_turn(self) -> None:
        for _ in range(_AT_ONCE):
            if self._has_more():
                self._wait(_MOMENT)
                return
            if not self._take():
                return

    def _take(self) -> bool:
        """Take one connection; false where there is none, or no room for it."""
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
        self._waiting = self._loop.call_later(seconds, self._go_on)

    def _go_on(self) -> None:
        """Take one, which nobody else did; then again as many as others."""
        self._waiting = None
        self._take()
        if self._waiting is None:
            self._listen()
