"""Test interrupts, and the threads of a run."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator

import pytest
from dh_grader.cli.running import mapped_in_threads
from dh_grader.cli.terminal import TERMINATED, interruptible

from tests.guards import ANSWER

# --- A signal always ends a command

needs_signals = pytest.mark.skipif(os.name == "nt", reason="has no signals between processes")


@pytest.fixture
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


@needs_signals
@pytest.mark.usefixtures("_interrupts_enabled")
def test_a_signal_ends_the_work() -> None:
    with pytest.raises(KeyboardInterrupt), interruptible():
        signal.raise_signal(signal.SIGINT)
    with pytest.raises(SystemExit, match=str(TERMINATED)), interruptible():
        signal.raise_signal(signal.SIGTERM)


@needs_signals
@pytest.mark.usefixtures("_interrupts_enabled")
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


@needs_signals
@pytest.mark.usefixtures("_interrupts_enabled")
def test_an_error_after_a_signal_does_not_replace_it(lose: Callable[[int], None]) -> None:
    def run() -> None:
        with interruptible():
            lose(signal.SIGINT)
            raise OSError("a process is gone")

    with pytest.raises(KeyboardInterrupt):
        run()


@needs_signals
@pytest.mark.usefixtures("_interrupts_enabled")
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


@needs_signals
@pytest.mark.usefixtures("_interrupts_enabled")
def test_ignored_signals_stay_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with interruptible() as check:
            signal.raise_signal(signal.SIGINT)
            check()
        assert signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


# --- Threads


def test_results_come_in_the_order_of_the_items() -> None:
    second_is_done = threading.Event()

    def work(item: int) -> int:
        if item == 0:
            assert second_is_done.wait(ANSWER)
        else:
            second_is_done.set()
        return item * item

    with mapped_in_threads(work, range(20), 2) as results:
        assert list(results) == [item * item for item in range(20)]


def test_only_few_items_are_computed_ahead() -> None:
    begun: list[int] = []
    with mapped_in_threads(begun.append, range(1000), 2) as results:
        next(results)
        assert len(begun) <= 6
    assert len(begun) <= 6


def test_the_end_of_the_context_does_not_wait_for_threads() -> None:
    begun, released = threading.Event(), threading.Event()

    def work(item: int) -> None:
        if item:
            begun.set()
            released.wait(ANSWER)

    with mapped_in_threads(work, range(9), 1) as results:
        next(results)
        assert begun.wait(ANSWER)
    assert not released.is_set()
    released.set()


def test_an_exception_in_a_thread_is_raised_in_place_of_its_result() -> None:
    with mapped_in_threads(lambda item: 1 // item, [1, 0], 2) as results:
        assert next(results) == 1
        with pytest.raises(ZeroDivisionError):
            next(results)
