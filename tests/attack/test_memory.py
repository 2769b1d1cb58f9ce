"""Run a small part of `python -m tests.attack.memory`."""

from itertools import islice

import pytest

from tests.attack.memory import measured, posts, resident


def test_no_two_requests_are_the_same() -> None:
    assert len(set(islice(posts("suite"), 400))) == 400


def test_a_few_requests_need_little_memory() -> None:
    found = measured(40, 20, "suite")
    assert found.failures == 0
    # The caches are not yet full after so few.
    assert not found.growth > 50


def test_the_measured_memory_grows_with_allocations() -> None:
    before = resident()
    if before != before:
        pytest.skip("this system does not say")
    kept = bytearray(b"x" * 30_000_000)
    assert resident() - before > 20
    assert kept
