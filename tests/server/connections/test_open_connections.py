"""Who makes room when there are too many connections, or when they hold too much."""

import asyncio
import resource
from collections.abc import Iterator
from dataclasses import dataclass, field

import pytest

from service.server.connections import open_connections as crowd_module
from service.server.connections.open_connections import Crowd, Room, room_here
from service.server.limits import RESERVE


@dataclass(eq=False)
class Line:
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


def ended(lines: list[Line]) -> list[int]:
    return [i for i, line in enumerate(lines) if line.ended]


def test_those_of_whom_there_are_most_make_room_the_longest_waiting_first(
    loop: asyncio.AbstractEventLoop,
) -> None:
    crowd = Crowd(Room(connections=16))
    honest = [Line("a", 0.0), Line("b", 25.0)]
    many = [Line("c", float(20 - i)) for i in range(14)]
    for line in [*honest, *many]:
        assert crowd.enter(line, loop)
    assert ended([*honest, *many]) == []
    assert crowd.enter(Line("d", 30.0), loop)
    # A sixteenth of 16 more than needed; the last two of the many have waited longest.
    assert (ended(honest), ended(many)) == ([], [12, 13])
    assert len(crowd) == 15


def test_whole_requests_are_not_dropped_and_the_reserve_is_for_questions_about_health(
    loop: asyncio.AbstractEventLoop,
) -> None:
    crowd = Crowd(Room(connections=4))
    lines = [Line("a", None) for _ in range(4 + RESERVE)]
    for i, line in enumerate(lines):
        assert crowd.enter(line, loop)
        assert crowd.full == (i >= 4)
    assert not crowd.enter(Line("b", 0.0), loop)
    assert ended(lines) == []
    crowd.leave(lines[0])
    assert crowd.enter(Line("b", 0.0), loop)


def test_whoever_holds_most_makes_room_for_more_bytes(loop: asyncio.AbstractEventLoop) -> None:
    crowd = Crowd(Room(unfinished=1000))
    large = [Line("a", 1.0), Line("a", 2.0), Line("a", None)]
    small = Line("b", 0.0)
    idle = Line("a", 0.0)
    for line in [*large, small, idle]:
        crowd.enter(line, loop)
    for line, size in [(large[0], 400), (large[1], 300), (small, 200), (large[2], 0)]:
        crowd.hold(line, size)
    assert ended([*large, small, idle]) == []
    crowd.hold(small, 301)
    assert ended([*large, small, idle]) == [0]
    # What has gone holds nothing: 601 bytes are left.
    crowd.hold(large[1], 699)
    assert ended([*large, small, idle]) == [0]
    crowd.hold(large[1], 700)
    assert ended([*large, small, idle]) == [0, 1]


def test_time_is_up_for_whoever_is_late(
    loop: asyncio.AbstractEventLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(crowd_module, "SWEEP", 0.001)
    crowd = Crowd(Room())
    late, early = Line("a", 0.0, deadline=loop.time()), Line("a", 0.0, deadline=loop.time() + 99)
    for line in (late, early):
        crowd.enter(line, loop)

    async def until_expired() -> None:
        while not late.ended:
            await asyncio.sleep(0.001)

    loop.run_until_complete(until_expired())
    assert (late.ended[0], early.ended) == ("expired", [])


def test_there_is_room_for_as_many_as_files_may_be_open(monkeypatch: pytest.MonkeyPatch) -> None:
    limits = [256, 1024]
    monkeypatch.setattr(resource, "getrlimit", lambda _: tuple(limits))
    monkeypatch.setattr(resource, "setrlimit", lambda _, new: limits.__setitem__(0, new[0]))
    assert (room_here().connections, limits[0]) == (1024 - 96, 1024)
    limits[:] = [256, resource.RLIM_INFINITY]
    assert (room_here().connections, limits[0]) == (1000, 1096)
    limits[:] = [20000, 20000]
    assert (room_here().connections, limits[0]) == (1000, 20000)
