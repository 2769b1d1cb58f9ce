"""Ends from outside that leave nothing behind."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

# As a shell says it: 128 and the number of the signal.
INTERRUPTED: Final = 130
TERMINATED: Final = 143


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGTERM end this process as Ctrl-C does: unfinished files go, processes are ended."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _end(*_: object) -> None:
    raise SystemExit(TERMINATED)
