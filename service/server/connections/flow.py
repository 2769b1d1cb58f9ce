"""Flow control: when a connection reads, and how it closes."""

import asyncio
from typing import Any

from uvicorn.protocols.http.flow_control import FlowControl


class LingeringTransport:
    """A transport whose ``close`` lets the client read the last response first."""

    def __init__(self, transport: asyncio.Transport, finish: Any) -> None:
        self._transport = transport
        self.close = finish

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)


class Valve(FlowControl):
    """Flow control that keeps reading paused from ``hold`` to ``release``."""

    # uvicorn cannot resume it while the next request has to wait.

    shut = False

    def resume_reading(self) -> None:
        """Resume reading, unless ``hold`` has paused it."""
        if not self.shut:
            super().resume_reading()

    def hold(self) -> None:
        """Pause reading until ``release``."""
        self.shut = True
        self.pause_reading()

    def release(self) -> None:
        """Resume reading."""
        self.shut = False
        self.resume_reading()
