"""Giving way to other clients in the midst of a long request."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Final

from fastapi import Request

# Where a layer around the application leaves, in the scope of a request, what waits for its turn.
TURN: Final = "dh_grader.turn"
# Where a layer before it leaves whose request it is, if that is not known by the address alone.
CLIENT: Final = "dh_grader.client"


async def give_way(request: Request) -> None:
    """Let others come first whose turn it is. Raises ClientDisconnect where nobody listens."""
    turn: Callable[[], Awaitable[None]] | None = request.scope.get(TURN)
    # Without such a layer, as in tests of the routes alone: each that is ready, once.
    await (asyncio.sleep(0) if turn is None else turn())
