"""Long work in slices of time: the event loop serves others between them.

A grading is a function of plain Python that may take 60 ms. ``in_slices`` runs it in a greenlet, a
stack of its own, which can be left in the midst and entered again. The work says at ``checkpoint``
where that may be; what it computes does not depend on it.
"""

import contextvars
import math
from collections.abc import Awaitable, Callable
from time import perf_counter
from typing import Any, Final, TypeVar

from greenlet import GreenletExit, getcurrent, greenlet

R = TypeVar("R")

# Seconds that work goes on until the next checkpoint stops it.
SLICE: Final = 0.004

# The time at which the present slice ends. There is one for the whole process: ``in_slices`` is
# called in the thread of the event loop alone, and other threads are never stopped.
_end = math.inf


class _Sliced(greenlet):  # type: ignore[misc]
    """Work that can be stopped and continued; ``stopped`` counts the seconds in between."""

    stopped = 0.0


def checkpoint() -> None:
    """Stop here until it is this work's turn again, if its slice is over."""
    if perf_counter() < _end:
        return
    current = getcurrent()
    if isinstance(current, _Sliced):
        began = perf_counter()
        current.parent.switch()
        current.stopped += perf_counter() - began


def working_time() -> float:
    """Return a time in seconds that stands still while the present work is stopped."""
    current = getcurrent()
    return perf_counter() - (current.stopped if isinstance(current, _Sliced) else 0.0)


async def in_slices(work: Callable[[], R], give_way: Callable[[], Awaitable[None]]) -> R:
    """Return the result of ``work``; ``give_way`` is awaited between its slices.

    Raises what either of them raises; work that is given up is ended at its checkpoint.
    """
    sliced = _Sliced(work)
    sliced.gr_context = contextvars.copy_context()
    try:
        result: R = _slice(sliced)
        while not sliced.dead:
            await give_way()
            result = _slice(sliced)
        return result
    finally:
        if not sliced.dead:
            sliced.throw(GreenletExit)


def _slice(sliced: _Sliced) -> Any:
    global _end
    _end = perf_counter() + SLICE
    try:
        return sliced.switch()
    finally:
        _end = math.inf
