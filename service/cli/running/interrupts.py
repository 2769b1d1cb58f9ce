"""Ends from outside that leave nothing behind."""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final, NoReturn

# As a shell says it: 128 and the number of the signal.
INTERRUPTED: Final = 130
TERMINATED: Final = 143
# Programs that end others often send their signal twice.
_TWICE: Final = 1.0


class _Signals:
    """The signals that came, and when the last one did."""

    def __init__(self) -> None:
        self._last: tuple[int, float] | None = None

    def receive(self, number: int, _: object) -> None:
        """End the process. What comes right after does not break its clearing up."""
        now = time.monotonic()
        if self._last is None or now - self._last[1] > _TWICE:
            self._last = number, now
            _end(number)

    def check(self) -> None:
        """End the process where a signal came and the exception that it raised was lost.

        Python drops one that is raised while it collects garbage or lets a lock go.
        """
        if self._last is not None:
            _end(self._last[0])


@contextmanager
def interruptible() -> Iterator[Callable[[], None]]:
    """Let SIGTERM end this process as Ctrl-C does: unfinished files go, processes are ended.

    To be called between two pieces of work, it yields what ends the process where a signal came
    that has not done so. No other exception takes the place of the end.
    """
    signals = _Signals()
    with _handled(signals.receive):
        try:
            yield signals.check
        except BaseException:
            signals.check()
            raise


@contextmanager
def _handled(handler: Callable[[int, object], None]) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    # A signal that this process was started to ignore, as in the background of a script, stays so.
    numbers = [n for n in (signal.SIGINT, signal.SIGTERM) if signal.getsignal(n) != signal.SIG_IGN]
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, former in before.items():
            signal.signal(number, former)


def _end(number: int) -> NoReturn:
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    raise SystemExit(TERMINATED)
