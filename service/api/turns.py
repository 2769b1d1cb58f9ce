"""Turns between clients, as the routes and the layers around them see it."""

import asyncio
import math
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Final, NamedTuple, TypeVar

from fastapi import Request

from service.time_slices import in_slices

R = TypeVar("R")

# Where a layer around the application leaves, in the scope of a request, what waits for its turn.
TURN: Final = "dh_grader.turn"
# Where a layer before it leaves the client of a request, if it is not known by the address alone.
CLIENT: Final = "dh_grader.client"


class Client(NamedTuple):
    """The client that a request belongs to.

    It has a share of the processor for each request that it has here, ``most_shares`` at most: the
    server of a course, or the address of a university, speaks for many students.
    """

    name: str
    most_shares: float

    @property
    def is_trusted(self) -> bool:
        """Whether there is no bound for this client alone."""
        return self.most_shares == math.inf


# A student; an address, which may be a class or somebody who wants to keep it out; a course site.
ONE_STUDENT, ONE_ADDRESS, COURSE_SITE = 1.0, 8.0, math.inf


async def give_way(request: Request) -> None:
    """Let others come first whose turn it is. Raises ClientDisconnect if the client has gone."""
    turn: Callable[[], Awaitable[None]] | None = request.scope.get(TURN)
    # Without such a layer, as in tests of the routes alone: each that is ready, once.
    await (asyncio.sleep(0) if turn is None else turn())


async def giving_way(request: Request, work: Callable[[], R]) -> R:
    """Return the result of ``work``, which gives way to other requests between its steps.

    Raises ClientDisconnect if the client has gone meanwhile, and what ``work`` raises.
    """
    return await in_slices(work, partial(give_way, request))
