"""Handle SIGINT and SIGTERM so that no unfinished files and no processes are left."""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final, NoReturn

# The exit codes of a shell: 128 plus the number of the signal.
INTERRUPTED: Final = 130
TERMINATED: Final = 143
# A second signal within this time is ignored: many programs send theirs twice (seconds).
_REPEATED_WITHIN: Final = 1.0


class _Signals:
    def __init__(self) -> None:
        self._last: tuple[int, float] | None = None

    def receive(self, number: int, _: object) -> None:
        # A further signal during the cleanup is ignored.
        now = time.monotonic()
        if self._last is None or now - self._last[1] > _REPEATED_WITHIN:
            self._last = number, now
            _end(number)

    def check(self) -> None:
        # Python drops exceptions that are raised during garbage collection or the release of a
        # lock.
        if self._last is not None:
            _end(self._last[0])


@contextmanager
def interruptible() -> Iterator[Callable[[], None]]:
    """Clean up files and processes before SIGTERM or Ctrl-C ends this process.

    Yields a function that ends the process after a signal. Call this function between two pieces of
    work.
    """
    # Without it, the process would go on if the exception of a signal was lost.
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
    # Keep ignoring signals that were ignored at the start, as in the background of a script.
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
