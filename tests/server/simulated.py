"""Simulate clients of one process on a simulated clock."""

# The event loop and the admission are real. The waiting times are exact, however busy this machine
# is.

import asyncio
import selectors
from collections.abc import Coroutine
from typing import Any

import pytest
from dh_grader.api.http import CLIENT, COURSE_SITE, Client, give_way
from dh_grader.server import turns as admission
from dh_grader.server import turns as speed
from dh_grader.server.turns import FairAdmission
from dh_grader.slices import FIRST_SLICE, SLICE
from starlette.requests import Request

# Seconds from an answer to the client's next request: the wire, and the client's own work.
WIRE = 0.0003
# Seconds that an ordinary wrong table takes on the simulated machine.
ORDINARY = 0.0075


def simulate_speed(monkeypatch: pytest.MonkeyPatch, slower: float = 1.0) -> None:
    # Let the service find the speed of the simulated machine instead of this machine's speed.
    monkeypatch.setattr(speed, "_measured", lambda: slower * ORDINARY / speed.ORDINARY)


class _Clock(selectors.SelectSelector):
    """A selector that advances the simulated clock instead of waiting."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 0.0

    def select(self, timeout: float | None = None) -> list[Any]:
        self.now += timeout or 0.0
        return []


class Process:
    """A simulated process; each request says how long it takes."""

    # A grading has a checkpoint every `step` seconds, at which it may be suspended. `slower` is the
    # factor by which the simulated machine is slower than usual.
    def __init__(
        self, monkeypatch: pytest.MonkeyPatch, step: float = 0.001, slower: float = 1.0
    ) -> None:
        self._step = step
        self._clock = _Clock()
        self.loop = asyncio.SelectorEventLoop(self._clock)
        monkeypatch.setattr(self.loop, "time", lambda: self._clock.now)
        monkeypatch.setattr(admission, "thread_time", lambda: self._clock.now)
        simulate_speed(monkeypatch, slower)
        self._app = FairAdmission(self._work)

    def run(self, seconds: float, *clients: Coroutine[Any, Any, None]) -> None:
        """Run the clients for a number of simulated seconds."""

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
        began, length = self.now, FIRST_SLICE
        for i, seconds in enumerate(scope["costs"]):
            left = seconds
            while left > 0:
                if self.now - began >= length or (i and left == seconds):
                    await give_way(Request(scope))
                    began, length = self.now, SLICE
                self._clock.now += min(self._step, left)
                left -= self._step

    async def pause(self, seconds: float) -> None:
        """Wait in one client for a number of simulated seconds."""
        await asyncio.sleep(seconds)

    async def ask(
        self, address: str, port: int, size: int, *costs: float, trusted: bool = False
    ) -> float:
        """Send one request; return the seconds until its response."""
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
