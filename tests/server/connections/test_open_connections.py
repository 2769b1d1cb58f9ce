"""Test which connections are closed when there are too many."""

import asyncio
import resource
from collections.abc import Iterator
from dataclasses import dataclass, field

import pytest
from dh_grader.server import connections as module
from dh_grader.server.connections import RESERVE, ConnectionLimits, OpenConnections, allowed_here


@dataclass(eq=False)
class FakeConnection:
    """A connection that has been waiting since ``waiting_since``."""

    address: str
    waiting_since: float | None
    deadline: float = float("inf")
    unfinished: int = 0
    ended: list[str] = field(default_factory=list)

    def expire(self) -> None:
        self.ended.append("expired")

    def reset(self) -> None:
        self.ended.append("reset")


@pytest.fixture
def loop() -> Iterator[asyncio.AbstractEventLoop]:
    loop = asyncio.new_event_loop()
    try:
        yield loop
    finally:
        loop.close()


def closed(lines: list[FakeConnection]) -> list[int]:
    return [i for i, line in enumerate(lines) if line.ended]


def test_the_address_with_most_connections_loses_its_longest_waiting_ones(
    loop: asyncio.AbstractEventLoop,
) -> None:
    connections = OpenConnections(ConnectionLimits(connections=16))
    honest = [FakeConnection("a", 0.0), FakeConnection("b", 25.0)]
    many = [FakeConnection("c", float(20 - i)) for i in range(14)]
    for line in [*honest, *many]:
        assert connections.enter(line, loop)
    assert closed([*honest, *many]) == []
    assert connections.enter(FakeConnection("d", 30.0), loop)
    # One more than needed is closed; the last two of the many have waited longest.
    assert (closed(honest), closed(many)) == ([], [12, 13])
    assert len(connections) == 15


def test_complete_requests_are_not_dropped_and_the_reserve_is_for_health_checks(
    loop: asyncio.AbstractEventLoop,
) -> None:
    connections = OpenConnections(ConnectionLimits(connections=4))
    lines = [FakeConnection("a", None) for _ in range(4 + RESERVE)]
    for i, line in enumerate(lines):
        assert connections.enter(line, loop)
        assert connections.full == (i >= 4)
    assert not connections.enter(FakeConnection("b", 0.0), loop)
    assert closed(lines) == []
    connections.leave(lines[0])
    assert connections.enter(FakeConnection("b", 0.0), loop)


def test_the_address_that_holds_most_bytes_loses_its_longest_waiting_connection(
    loop: asyncio.AbstractEventLoop,
) -> None:
    connections = OpenConnections(ConnectionLimits(unfinished=1000))
    large = [FakeConnection("a", 1.0), FakeConnection("a", 2.0), FakeConnection("a", None)]
    small = FakeConnection("b", 0.0)
    idle = FakeConnection("a", 0.0)
    for line in [*large, small, idle]:
        connections.enter(line, loop)
    for line, size in [(large[0], 400), (large[1], 300), (small, 200), (large[2], 0)]:
        connections.set_unfinished(line, size)
    assert closed([*large, small, idle]) == []
    connections.set_unfinished(small, 301)
    assert closed([*large, small, idle]) == [0]
    # A closed connection holds no bytes: 601 bytes are left.
    connections.set_unfinished(large[1], 699)
    assert closed([*large, small, idle]) == [0]
    connections.set_unfinished(large[1], 700)
    assert closed([*large, small, idle]) == [0, 1]


def test_a_connection_expires_at_its_deadline(
    loop: asyncio.AbstractEventLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "SWEEP", 0.001)
    connections = OpenConnections(ConnectionLimits())
    late, early = (
        FakeConnection("a", 0.0, deadline=loop.time()),
        FakeConnection("a", 0.0, deadline=loop.time() + 99),
    )
    for line in (late, early):
        connections.enter(line, loop)

    async def until_expired() -> None:
        while not late.ended:
            await asyncio.sleep(0.001)

    loop.run_until_complete(until_expired())
    assert (late.ended[0], early.ended) == ("expired", [])


def test_the_limit_of_connections_follows_the_limit_of_open_files(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    limits = [256, 1024]
    monkeypatch.setattr(resource, "getrlimit", lambda _: tuple(limits))
    monkeypatch.setattr(resource, "setrlimit", lambda _, new: limits.__setitem__(0, new[0]))
    assert (allowed_here().connections, limits[0]) == (1024 - 96, 1024)
    limits[:] = [256, resource.RLIM_INFINITY]
    assert (allowed_here().connections, limits[0]) == (1000, 1096)
    limits[:] = [20000, 20000]
    assert (allowed_here().connections, limits[0]) == (1000, 20000)
