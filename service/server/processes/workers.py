"""Several worker processes that serve one port, and their supervisor."""

import logging
import multiprocessing
import os
import signal
import socket
import time
from collections.abc import Callable
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from typing import Final

from service.server.limits import GRACE
from service.server.processes.process import SHUTTING_DOWN
from service.server.processes.shared_port import ConnectionCounts, SharedPort

# Seconds after the grace period until a worker is killed.
_MARGIN: Final = 1.5
# Seconds until a worker that has ended is replaced.
_PAUSE: Final = 1.0
# Seconds between two checks whether the first worker listens.
_POLL: Final = 0.05

_log = logging.getLogger("uvicorn.error")


class Supervisor:
    """Keeps ``number`` workers running until a signal comes."""

    def __init__(
        self,
        work: Callable[[SharedPort], None],
        listener: socket.socket,
        number: int,
        announce: Callable[[], None],
        lost: Callable[[int], None] = lambda _: None,
    ) -> None:
        # Called as soon as a worker listens; logs that the service is running.
        self._announce = announce
        # Called with the process id of a worker that has ended.
        self._lost = lost
        self._work = work
        self._listener = listener
        self._counts = ConnectionCounts.of(number)
        self._workers: list[BaseProcess] = []
        self._signals = 0
        self._last = signal.SIGTERM.value

    def run(self) -> bool:
        """Run until a signal comes; return False if no worker could start."""
        # A signal writes to this socket, which wakes the process.
        awake, alarm = socket.socketpair()
        with awake, alarm:
            alarm.setblocking(False)
            signal.set_wakeup_fd(alarm.fileno())
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, self._note)
            self._workers = [self._start(index) for index in range(len(self._counts.numbers))]
            started = self._watch(awake)
            self._listener.close()
            self._end(awake)
            signal.set_wakeup_fd(-1)
        if self._signals > 1:
            # As without workers, the second signal ends this process.
            signal.signal(self._last, signal.SIG_DFL)
            signal.raise_signal(self._last)
        return started

    def _note(self, number: int, _: object) -> None:
        self._signals += 1
        self._last = number

    def _start(self, index: int) -> BaseProcess:
        # A new interpreter: a fork would copy locks that another thread holds.
        context = multiprocessing.get_context("spawn")
        port = SharedPort(self._listener, self._counts, index, os.getpid())
        worker = context.Process(target=self._work, args=(port,))
        worker.start()
        return worker

    def _watch(self, awake: socket.socket) -> bool:
        announced = False
        while True:
            wait(
                [awake, *(worker.sentinel for worker in self._workers)],
                None if announced else _POLL,
            )
            if self._stopped():
                return True
            if not announced and self._counts.any_listening:
                announced = True
                self._announce()
            gone = [worker for worker in self._workers if not worker.is_alive()]
            if len(gone) == len(self._workers) and all(worker.exitcode == 1 for worker in gone):
                return False
            if not gone:
                continue
            for worker in gone:
                _log.error("Worker %s has ended (exit code %s)", worker.pid, worker.exitcode)
                self._counts.stop_listening(self._workers.index(worker))
                self._lost(worker.pid or 0)
            wait([awake], _PAUSE)
            if self._stopped():
                return True
            self._workers = [
                self._start(index) if worker in gone else worker
                for index, worker in enumerate(self._workers)
            ]

    def _stopped(self) -> bool:
        return self._signals > 0

    def _end(self, awake: socket.socket) -> None:
        _log.info(SHUTTING_DOWN)
        for worker in self._workers:
            worker.terminate()
        end = time.monotonic() + GRACE + _MARGIN
        while alive := [worker for worker in self._workers if worker.is_alive()]:
            left = end - time.monotonic()
            if self._signals > 1 or left <= 0:
                for worker in alive:
                    worker.kill()
                break
            awake.setblocking(False)
            _drain(awake)
            wait([awake, *(worker.sentinel for worker in alive)], left)
        for worker in self._workers:
            worker.join()


def _drain(awake: socket.socket) -> None:
    try:
        awake.recv(64)
    except BlockingIOError:
        return
