"""A signal always ends a command."""

import os
import signal
import sys
from collections.abc import Callable, Iterator

import pytest
from dh_grader.cli.terminal import TERMINATED, interruptible

pytestmark = pytest.mark.skipif(os.name == "nt", reason="has no signals between processes")


@pytest.fixture(autouse=True)
def _interrupts_enabled() -> Iterator[None]:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def lose(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    # A function that sends this process a signal whose exception Python drops.
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


def test_a_lost_signal_ends_the_work_at_the_next_check(lose: Callable[[int], None]) -> None:
    with interruptible() as check:
        check()
        lose(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            check()
    with interruptible() as check:
        lose(signal.SIGTERM)
        with pytest.raises(SystemExit, match=str(TERMINATED)):
            check()


def test_an_error_after_a_signal_does_not_replace_it(lose: Callable[[int], None]) -> None:
    def run() -> None:
        with interruptible():
            lose(signal.SIGINT)
            raise OSError("a process is gone")

    with pytest.raises(KeyboardInterrupt):
        run()


def test_a_second_signal_does_not_interrupt_the_cleanup() -> None:
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


def test_ignored_signals_stay_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with interruptible() as check:
            signal.raise_signal(signal.SIGINT)
            check()
        assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
