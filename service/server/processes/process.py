"""One server process: uvicorn with limits for connections, and an orderly shutdown."""

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
from service.server.limits import FORCED_EXIT, GRACE
from service.server.processes.shared_port import Acceptor, SharedPort

_log = logging.getLogger("uvicorn.error")

# The log line after the first signal, so that nobody sends a second one by mistake.
SHUTTING_DOWN: Final = (
    f"Shutting down: open requests are still answered, for at most {GRACE:g} s. "
    "A second signal ends the process at once."
)
_SIGNALS: Final = (signal.SIGINT, signal.SIGTERM)


class Server(uvicorn.Server):
    """A server that, after a signal, answers open requests and exits within ten seconds."""

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
        # The process id of this worker's supervisor. The worker ends if the supervisor dies.
        self._parent = port.supervisor if port else None
        self._acceptor: Acceptor | None = None

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Handle signals while the server runs, so that a signal leads to exit code 0."""
        before = {number: signal.signal(number, self.handle_exit) for number in _SIGNALS}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002
        """Begin to shut down; at a second signal, end at once."""
        if self._parent is not None:
            # A worker ignores Ctrl+C, which also reaches the supervisor; that ends the workers.
            self.should_exit = self.should_exit or sig == signal.SIGTERM
        elif self.should_exit:
            signal.signal(sig, signal.SIG_DFL)
            signal.raise_signal(sig)
        else:
            self.should_exit = True
            # An empty context: the log line must not name the request that was interrupted.
            Context().run(_log.info, SHUTTING_DOWN)

    async def on_tick(self, counter: int) -> bool:
        """True if the server has to end, because of a signal or a dead supervisor."""
        if self._acceptor is not None:
            self._acceptor.publish_count()
        orphaned = self._parent is not None and os.getppid() != self._parent
        return await super().on_tick(counter) or orphaned

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen on the port that all workers share, or on a separate port of this process."""
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
        """Answer open requests for a while, then close all connections."""
        _force_exit_later()
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
            # They notice that their clients have gone.
            _, hanging = await asyncio.wait(tasks, timeout=0.5)
            for task in hanging:
                task.cancel()
        await self.lifespan.shutdown()

    def _guarded(self) -> list[GuardedProtocol]:
        found = list(self.server_state.connections)
        return [connection for connection in found if isinstance(connection, GuardedProtocol)]


def _force_exit_later() -> None:
    # Without this, Python would wait for a thread that is still running.
    def end() -> None:
        _log.warning(
            "Something does not react, for example the database: exiting without waiting for it."
        )
        os._exit(0)

    timer = threading.Timer(GRACE + FORCED_EXIT, end)
    timer.daemon = True
    timer.start()
