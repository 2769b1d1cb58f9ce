"""Threads that send what is queued in the database."""

import logging
import threading
from collections.abc import Callable
from datetime import datetime, timedelta
from typing import Final, Protocol

from sqlalchemy import Connection, Engine, event
from sqlalchemy.exc import SQLAlchemyError

_log = logging.getLogger(__name__)

# How often a thread looks for work that other processes have queued (seconds).
_LOOK: Final = 20.0
_LEAST: Final = 0.05


class Sender(Protocol):
    """Sends queued items one by one, in the thread of a BackgroundSending."""

    now: Callable[[], datetime]

    def send_next(self) -> bool:
        """Send the next item that is due; return False if none is due."""

    def next_due(self) -> datetime | None:
        """Return when the next item may be sent; None if no item waits."""


class BackgroundSending:
    """A thread that sends queued items as soon as this process has committed them."""

    def __init__(self, engine: Engine, sender: Sender, queued: str) -> None:
        # A transaction that queues an item sets ``queued`` in Connection.info. No other thread may
        # commit during this call, because a commit iterates over the listeners.
        self._sender, self._queued = sender, queued
        self._wake = threading.Event()
        self._closed = threading.Event()
        event.listen(engine, "commit", self._committed)
        self._thread = threading.Thread(target=self._run, name=queued, daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def close(self) -> None:
        """Stop the thread after the current item."""
        self._closed.set()
        self._wake.set()
        self._thread.join()

    def _committed(self, connection: Connection) -> None:
        # One that is closed leaves the note to its successor.
        if not self._closed.is_set() and connection.info.pop(self._queued, False):
            self._wake.set()

    def _run(self) -> None:
        while not self._closed.is_set():
            self._wake.clear()
            seconds = _LOOK
            try:
                while not self._closed.is_set() and self._sender.send_next():
                    pass
                due = self._sender.next_due()
                if due is not None:
                    wait = (due - self._sender.now()) / timedelta(seconds=1)
                    seconds = min(_LOOK, max(_LEAST, wait))
            except SQLAlchemyError:
                _log.warning("LTI: the database does not respond")
            except Exception:  # noqa: BLE001 - the next one may be sent
                _log.exception("LTI: sending failed (%s)", self._queued)
            self._wake.wait(seconds)
