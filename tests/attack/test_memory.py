"""A small sample of `python -m tests.attack.memory`: that it runs, and how requests differ."""

from itertools import islice

import pytest

from tests.attack.memory import course, posts, resident


def test_no_two_requests_are_the_same() -> None:
    assert len(set(islice(posts("suite"), 400))) == 400


def test_memory_of_a_few_requests() -> None:
    found = course(40, 20, "suite")
    assert found.failures == 0
    # The caches are not yet full after so few.
    assert not found.growth > 50


def test_the_memory_that_is_measured_is_that_of_the_process() -> None:
    before = resident()
    if before != before:
        pytest.skip("this system does not say")
    kept = bytearray(b"x" * 30_000_000)
    assert resident() - before > 20
    assert kept
