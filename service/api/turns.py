"""Share the processor fairly between the requests of clients."""

import asyncio
import math
from collections.abc import Awaitable, Callable
from datetime import UTC, datetime
from functools import partial
from typing import Final, NamedTuple, TypeVar

from fastapi import Request

from service.time_slices import in_slices

R = TypeVar("R")

# The key of a request's ASGI scope under which a layer leaves the function that awaits a turn.
TURN: Final = "dh_grader.turn"
# The key under which this layer leaves the moment at which it had received the whole request.
ARRIVED: Final = "dh_grader.arrived"
# The key under which an earlier layer leaves the client, unless that is just the address.
CLIENT: Final = "dh_grader.client"


class Client(NamedTuple):
    """The client that sent a request.

    A client with several requests at once gets more processor time: up to ``most_shares`` times as
    much.
    """

    # A course's server or a university's address may have several shares, because it sends the
    # requests of many students.

    name: str
    most_shares: float

    @property
    def is_trusted(self) -> bool:
        """True if the client's part of the processor time has no limit."""
        return self.most_shares == math.inf


# The shares of a student, of an address (a class, or an attacker), and of a course site.
ONE_STUDENT, ONE_ADDRESS, COURSE_SITE = 1.0, 8.0, math.inf


def arrived_at(request: Request) -> datetime:
    """Return the time when the whole request was received."""
    # This time decides whether answers were handed in late.
    found: datetime | None = request.scope.get(ARRIVED)
    return found or datetime.now(UTC)


async def give_way(request: Request) -> None:
    """Let other requests run, and wait until this request may continue.

    Raises ClientDisconnect.
    """
    turn: Callable[[], Awaitable[None]] | None = request.scope.get(TURN)
    # Without such a layer, as in tests of routes: let every other ready task run once.
    await (asyncio.sleep(0) if turn is None else turn())


async def run_in_turns(request: Request, work: Callable[[], R]) -> R:
    """Call ``work`` and return its result; let other requests run meanwhile.

    Raises ClientDisconnect.
    """
    return await in_slices(work, partial(give_way, request))
