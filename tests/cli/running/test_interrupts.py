"""A signal ends a run however it meets it."""

import os
import signal
import sys
from collections.abc import Callable, Iterator

import pytest

from service.cli.running.interrupts import TERMINATED, interruptible

pytestmark = pytest.mark.skipif(os.name == "nt", reason="has no signals between processes")


@pytest.fixture(autouse=True)
def _as_in_a_terminal() -> Iterator[None]:
    """A suite that was started in the background ignores interrupts."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def lose(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Sends this process a signal whose exception Python drops."""
    monkeypatch.setattr(sys, "unraisablehook", lambda _: None)

    def lose(number: int) -> None:
        class Garbage:
            def __del__(self) -> None:
                signal.raise_signal(number)

        Garbage()

    return lose


def test_a_signal_ends_the_work() -> None:
    with pytest.raises(KeyboardInterrupt), interruptible():
        signal.raise_signal(signal.SIGINT)
    with pytest.raises(SystemExit, match=str(TERMINATED)), interruptible():
        signal.raise_signal(signal.SIGTERM)


def test_one_that_was_lost_ends_it_between_two_pieces(lose: Callable[[int], None]) -> None:
    with interruptible() as check:
        check()
        lose(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            check()
    with interruptible() as check:
        lose(signal.SIGTERM)
        with pytest.raises(SystemExit, match=str(TERMINATED)):
            check()


def test_what_fails_after_it_is_not_the_reason(lose: Callable[[int], None]) -> None:
    def run() -> None:
        with interruptible():
            lose(signal.SIGINT)
            raise OSError("a process is gone")

    with pytest.raises(KeyboardInterrupt):
        run()


def test_a_second_one_at_once_does_not_break_the_clearing_up() -> None:
    cleared = []

    def run() -> None:
        with interruptible():
            try:
                signal.raise_signal(signal.SIGINT)
            finally:
                signal.raise_signal(signal.SIGINT)
                cleared.append(True)

    with pytest.raises(KeyboardInterrupt):
        run()
    assert cleared


def test_what_was_to_be_ignored_stays_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with interruptible() as check:
            signal.raise_signal(signal.SIGINT)
            check()
        assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
