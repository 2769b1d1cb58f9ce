"""The thread of a service that sends scores. It sleeps while nothing waits."""

import logging
import threading
from datetime import timedelta
from typing import Final

from sqlalchemy import Connection, Engine, event
from sqlalchemy.exc import SQLAlchemyError

from service.access.keys import Secret
from service.attempts.storage.score_queue import QUEUED
from service.lti.scores.sender import ScoreSender

_log = logging.getLogger(__name__)

# How often the thread looks for scores that other processes have queued (seconds).
_LOOK: Final = 20.0
_LEAST: Final = 0.05


class ScoreSending:
    """A thread that sends scores as soon as this process has committed them."""

    def __init__(self, engine: Engine, secret: Secret) -> None:
        """Start the thread."""
        self._engine = engine
        self._sender = ScoreSender(engine, secret)
        self._wake = threading.Event()
        self._closed = threading.Event()
        event.listen(engine, "commit", self._committed)
        self._thread = threading.Thread(target=self._run, name="scores", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop the thread after the score that it is sending."""
        self._closed.set()
        self._wake.set()
        self._thread.join()
        event.remove(self._engine, "commit", self._committed)

    def _committed(self, connection: Connection) -> None:
        if connection.info.pop(QUEUED, False):
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
                _log.warning("LTI: the database of the scores does not answer")
            except Exception:  # noqa: BLE001 - the next score may be sent
                _log.exception("LTI: scores cannot be sent")
            self._wake.wait(seconds)
