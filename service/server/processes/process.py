"""One process that serves: uvicorn with connections under limits, and an end in good order."""

import asyncio
import contextlib
import logging
import os
import signal
import socket
import threading
from collections.abc import Iterator, Sequence
from contextvars import Context
from types import FrameType
from typing import Final

import uvicorn

from service.api.monitor import Monitor
from service.server.connections.guarded_state import GuardedState
from service.server.connections.protocol import GuardedProtocol
from service.server.limits import GRACE, LAST
from service.server.processes.shared_port import Acceptor, SharedPort

_log = logging.getLogger("uvicorn.error")

# Who waits for the end must not send the second signal by mistake.
ENDING: Final = (
    f"Ending: requests that have come are answered, for {GRACE:g} s at most. "
    "A second signal ends at once."
)
_SIGNALS: Final = (signal.SIGINT, signal.SIGTERM)


class Server(uvicorn.Server):
    """A server that ends by a signal: it answers what it has, for ten seconds at most."""

    def __init__(
        self,
        config: uvicorn.Config,
        port: SharedPort | None = None,
        origins: Sequence[str] = (),
        monitor: Monitor | None = None,
    ) -> None:
        super().__init__(config)
        self.server_state: GuardedState = GuardedState(origins, monitor)
        self._port = port
        # The supervisor of this worker, which alone sends signals and must not die before it.
        self._parent = port.supervisor if port else None
        self._acceptor: Acceptor | None = None

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """End in good order by the first signal; the exit code is then 0."""
        before = {number: signal.signal(number, self.handle_exit) for number in _SIGNALS}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002
        """Begin to end; by a second signal at once."""
        if self._parent is not None:
            # The terminal's Ctrl+C goes to the workers as well; the supervisor counts.
            self.should_exit = self.should_exit or sig == signal.SIGTERM
        elif self.should_exit:
            signal.signal(sig, signal.SIG_DFL)
            signal.raise_signal(sig)
        else:
            self.should_exit = True
            # The signal belongs to no request, whichever it has interrupted.
            Context().run(_log.info, ENDING)

    async def on_tick(self, counter: int) -> bool:
        """Whether to end: by a signal, or because nobody is left to send one."""
        if self._acceptor is not None:
            self._acceptor.note()
        orphaned = self._parent is not None and os.getppid() != self._parent
        return await super().on_tick(counter) or orphaned

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen, on a port that others share or on one of its own."""
        if self._port is None:
            await super().startup(sockets)
            return
        await super().startup(sockets=[])
        self._acceptor = Acceptor(
            self._port, lambda: len(self.server_state.connections), self._connection
        )

    def _connection(self) -> GuardedProtocol:
        return GuardedProtocol(self.config, self.server_state, self.lifespan.state)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:  # noqa: ARG002
        """Answer what has come whole, wait a while for the rest, and hang up on what is left."""
        _end_at_last()
        for server in self.servers:
            server.close()
        if self._acceptor is not None:
            self._acceptor.close()
        connections = self.server_state.connections
        for connection in self._guarded():
            connection.shutdown()
        loop = asyncio.get_running_loop()
        end = loop.time() + GRACE
        while connections and loop.time() < end:
            await asyncio.sleep(0.02)
        for connection in self._guarded():
            connection.reset()
        if tasks := list(self.server_state.tasks):
            # They find that nobody listens any more.
            _, hanging = await asyncio.wait(tasks, timeout=0.5)
            for task in hanging:
                task.cancel()
        await self.lifespan.shutdown()

    def _guarded(self) -> list[GuardedProtocol]:
        found = list(self.server_state.connections)
        return [connection for connection in found if isinstance(connection, GuardedProtocol)]


def _end_at_last() -> None:
    """End the process after the promised time, also if a thread is still at work.

    Python waits for its threads, and nothing ends one. What the database has confirmed is recorded.
    """

    def end() -> None:
        _log.warning(
            "Something does not react, such as the database: ended without waiting for it."
        )
        os._exit(0)

    timer = threading.Timer(GRACE + LAST, end)
    timer.daemon = True
    timer.start()
