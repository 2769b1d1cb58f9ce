"""All connections of one process: how many they are, what they hold, and who makes room.

A connection that does not let the process get on (no request yet, or an unfinished one) is closed
when there are too many, or when they hold too much: first those of the client that has most of
them, the longest waiting first. A request that has come whole is never dropped.
"""

import asyncio
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final, Protocol

# For admission, which imports it from here.
from service.server.limits import MAX_CONNECTIONS, MAX_UNFINISHED, OTHER_FILES, RESERVE, SWEEP

# The share of the connections that is closed at once, so that choosing them costs little for each.
_AT_ONCE: Final = 16


class Member(Protocol):
    """A connection, as the crowd sees it."""

    address: str
    # The time of the loop at which patience ends.
    deadline: float
    # The time since which it has been waiting; None while a whole request is being answered.
    waiting_since: float | None
    # Bytes of a request that is not whole.
    unfinished: int

    def expire(self) -> None:
        """End what has lasted too long."""

    def reset(self) -> None:
        """Hang up at once."""


@dataclass(frozen=True, slots=True)
class Room:
    """How many connections, and how many bytes of unfinished requests, there is room for."""

    connections: int = MAX_CONNECTIONS
    unfinished: int = MAX_UNFINISHED


class Crowd:
    """The connections of one process."""

    def __init__(self, room: Room) -> None:
        self._room = room
        self._members: dict[Member, None] = {}
        self._unfinished = 0
        self._sweeping: asyncio.TimerHandle | None = None

    def __len__(self) -> int:
        """How many connections there are."""
        return len(self._members)

    @property
    def full(self) -> bool:
        """Whether only questions about the service's health are answered."""
        return len(self._members) > self._room.connections

    def enter(self, member: Member, loop: asyncio.AbstractEventLoop) -> bool:
        """Take a connection in; false where there is no room even in the reserve."""
        if len(self._members) >= self._room.connections:
            self._make_room(_one, 1 + self._room.connections // _AT_ONCE)
        if len(self._members) >= self._room.connections + RESERVE:
            return False
        self._members[member] = None
        if self._sweeping is None:
            self._sweeping = loop.call_later(SWEEP, self._sweep, loop)
        return True

    def leave(self, member: Member) -> None:
        """Forget a connection."""
        if member in self._members:
            del self._members[member]
            self._unfinished -= member.unfinished
            member.unfinished = 0

    def hold(self, member: Member, size: int) -> None:
        """Note how many bytes of an unfinished request a connection holds now."""
        if member not in self._members:
            return
        self._unfinished += size - member.unfinished
        member.unfinished = size
        if self._unfinished > self._room.unfinished:
            excess = self._unfinished - self._room.unfinished
            self._make_room(_bytes, excess + self._room.unfinished // 4)

    def _make_room(self, weight: Callable[[Member], int], wanted: int) -> None:
        """Hang up on those who wait, until their weights add up to what is ``wanted``."""
        waiting = [m for m in self._members if m.waiting_since is not None and weight(m)]
        shares: Counter[str] = Counter()
        for member in waiting:
            shares[member.address] += weight(member)
        for member in by_turn(waiting, shares, weight):
            if wanted <= 0:
                break
            wanted -= weight(member)
            self.leave(member)
            member.reset()

    def _sweep(self, loop: asyncio.AbstractEventLoop) -> None:
        now = loop.time()
        for member in [m for m in self._members if m.deadline < now]:
            member.expire()
        self._sweeping = loop.call_later(SWEEP, self._sweep, loop) if self._members else None


def _one(_: Member) -> int:
    return 1


def _bytes(member: Member) -> int:
    return member.unfinished


def by_turn(
    waiting: Iterable[Member], shares: Counter[str], weight: Callable[[Member], int]
) -> Iterable[Member]:
    """Those who wait, always the longest waiting of the address that has most at that time."""
    queues: dict[str, list[Member]] = {}
    for member in sorted(waiting, key=lambda m: m.waiting_since or 0.0, reverse=True):
        queues.setdefault(member.address, []).append(member)
    while queues:
        address = max(queues, key=shares.__getitem__)
        member = queues[address].pop()
        shares[address] -= weight(member)
        if not queues[address]:
            del queues[address]
        yield member


def room_here() -> Room:
    """Room for as many connections as the process may open files; raises that limit if it can."""
    try:
        import resource
    except ImportError:  # Windows, which has no such limit
        return Room()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = MAX_CONNECTIONS + RESERVE + OTHER_FILES
    if soft != resource.RLIM_INFINITY and soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
        return Room(connections=max(1, min(MAX_CONNECTIONS, soft - RESERVE - OTHER_FILES)))
    return Room()
