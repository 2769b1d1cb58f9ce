import pytest
from dh_grader.client import GraderClientError, Retries

BUSY = GraderClientError("busy", is_temporary=True)


def test_the_waits_double_up_to_the_longest_and_are_random() -> None:
    retries = Retries(number=9, first_wait=0.5, longest_wait=4.0)
    for failures, longest in enumerate((0.5, 1.0, 2.0, 4.0, 4.0), start=1):
        waits = [retries.wait(failures, BUSY) or 0.0 for _ in range(200)]
        assert longest / 2 <= min(waits) < 0.6 * longest
        assert 0.9 * longest < max(waits) <= longest


def test_the_default_waits_are_fifteen_seconds_in_all() -> None:
    longest = [max(Retries().wait(i, BUSY) or 0.0 for _ in range(500)) for i in range(1, 6)]
    assert sum(longest) == pytest.approx(15.5, rel=0.02)
    assert Retries().wait(6, BUSY) is None


def test_a_wait_is_at_least_as_long_as_the_service_asks() -> None:
    retries = Retries(longest_wait=20.0)
    asked = GraderClientError("busy", is_temporary=True, retry_after=20.0)
    assert 20.25 <= (retries.wait(1, asked) or 0.0) <= 20.5
    long = GraderClientError("busy", is_temporary=True, retry_after=20.1)
    assert retries.wait(1, long) is None


def test_permanent_failures_are_not_retried() -> None:
    assert Retries().wait(1, GraderClientError("no")) is None
    assert Retries(number=0).wait(1, BUSY) is None
