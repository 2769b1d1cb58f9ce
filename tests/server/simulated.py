"""A simulation of clients and one process: its time passes by the work that is done, and by waits.

The event loop and the admission are the real ones, the clock is not: so waits are exact, however
busy the machine is.
"""

import asyncio
import selectors
from collections.abc import Coroutine
from typing import Any

import pytest
from starlette.requests import Request

from service.api.turns import CLIENT, COURSE_SITE, Client, give_way
from service.server.turns import admission
from service.server.turns.admission import FairAdmission
from service.time_slices import SLICE

# Seconds from an answer to the client's next request: the wire, and the client's own work.
WIRE = 0.0003


class _Clock(selectors.SelectSelector):
    """Waits for nothing: the time passes at once."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 0.0

    def select(self, timeout: float | None = None) -> list[Any]:
        self.now += timeout or 0.0
        return []


class Process:
    """A process behind the admission, in which each request takes the time that it says.

    A grading has checkpoints every ``step`` seconds, so it gives way after some of its steps.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch, step: float = 0.001) -> None:
        self._step = step
        self._clock = _Clock()
        self.loop = asyncio.SelectorEventLoop(self._clock)
        monkeypatch.setattr(self.loop, "time", lambda: self._clock.now)
        monkeypatch.setattr(admission, "thread_time", lambda: self._clock.now)
        self._app = FairAdmission(self._work)

    def run(self, seconds: float, *clients: Coroutine[Any, Any, None]) -> None:
        """Run the clients, as long as that."""

        async def all_of_them() -> None:
            tasks = [asyncio.ensure_future(client) for client in clients]
            await asyncio.sleep(seconds)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

        self.loop.run_until_complete(all_of_them())
        self.loop.close()

    @property
    def now(self) -> float:
        return self._clock.now

    async def _work(self, scope: Any, _receive: Any, _send: Any) -> None:
        began = self.now
        for i, seconds in enumerate(scope["costs"]):
            left = seconds
            while left > 0:
                if self.now - began >= SLICE or (i and left == seconds):
                    await give_way(Request(scope))
                    began = self.now
                self._clock.now += min(self._step, left)
                left -= self._step

    async def pause(self, seconds: float) -> None:
        """Let so much time pass for one client."""
        await asyncio.sleep(seconds)

    async def ask(
        self, address: str, port: int, size: int, *costs: float, trusted: bool = False
    ) -> float:
        """Send one request; how long its answer took."""
        asked = False

        async def receive() -> dict[str, Any]:
            nonlocal asked
            if asked:
                await self.loop.create_future()
            asked = True
            return {"type": "http.request", "body": b" " * size, "more_body": False}

        async def send(_: Any) -> None:
            return

        await asyncio.sleep(WIRE)
        began = self.now
        scope: dict[str, Any] = {
            "type": "http", "path": "/", "headers": [], "client": (address, port), "costs": costs,
        }  # fmt: skip
        if trusted:
            scope[CLIENT] = Client(address, COURSE_SITE)
        await self._app(scope, receive, send)
        return self.now - began
