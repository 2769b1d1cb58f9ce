"""Estimate the processing time of an ordinary request."""

from collections.abc import Iterator

import pytest
from dh_grader.server import turns as speed
from dh_grader.server.turns import Speed


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    times = [1e-4]

    def ticks() -> Iterator[float]:
        while True:
            yield times.pop(0) if len(times) > 1 else times[0]

    ticking = ticks()
    monkeypatch.setattr(speed, "_measured", lambda: next(ticking))
    return times


def test_a_machine_of_half_the_speed_takes_twice_as_long(measured: list[float]) -> None:
    fast = Speed().ordinary
    measured[0] *= 2
    assert Speed().ordinary == pytest.approx(2 * fast)


def test_a_few_slow_moments_do_not_count(measured: list[float]) -> None:
    quiet = Speed().ordinary
    measured[:0] = [1e-2] * 10
    assert Speed().ordinary == quiet


def test_a_machine_that_becomes_slower_is_noticed(measured: list[float]) -> None:
    estimate = Speed()
    fast = estimate.ordinary
    measured[0] *= 3
    for _ in range(1000):
        estimate.after_request()
    assert estimate.ordinary == pytest.approx(3 * fast)


def test_an_ordinary_request_takes_some_milliseconds() -> None:
    assert 0.001 < Speed().ordinary < 1.0
