"""Run long work in time slices, so that the event loop can serve other requests between them.

``in_slices`` runs a function in a greenlet, which can be suspended and resumed. The function calls
``checkpoint`` where it may be suspended.
"""

import contextvars
import math
from collections.abc import Awaitable, Callable
from time import perf_counter
from typing import Any, Final, TypeVar

from greenlet import GreenletExit, getcurrent, greenlet

R = TypeVar("R")

# The length of a slice (seconds); the next checkpoint after it suspends the work. Most gradings end
# in the first slice, which saves the time of a suspension.
FIRST_SLICE: Final = 0.01
SLICE: Final = 0.006

# The end of the current slice. One for the whole process is enough: ``in_slices`` is called only in
# the thread of the event loop, and other threads are never suspended.
_end = math.inf


class _Sliced(greenlet):  # type: ignore[misc]
    # The total time of suspension (seconds).
    suspended = 0.0


def checkpoint() -> None:
    """Suspend the current work if its time slice is over."""
    if perf_counter() < _end:
        return
    current = getcurrent()
    if isinstance(current, _Sliced):
        began = perf_counter()
        current.parent.switch()
        current.suspended += perf_counter() - began


def working_time() -> float:
    """Return the seconds on a clock that stops while the current work is suspended."""
    current = getcurrent()
    return perf_counter() - (current.suspended if isinstance(current, _Sliced) else 0.0)


async def in_slices(work: Callable[[], R], give_way: Callable[[], Awaitable[None]]) -> R:
    """Run ``work`` in time slices and return its result; await ``give_way`` between slices."""
    # If ``give_way`` raises an exception, ``work`` ends at its current checkpoint.
    sliced = _Sliced(work)
    sliced.gr_context = contextvars.copy_context()
    try:
        result: R = _slice(sliced, FIRST_SLICE)
        while not sliced.dead:
            await give_way()
            result = _slice(sliced, SLICE)
        return result
    finally:
        if not sliced.dead:
            sliced.throw(GreenletExit)


def _slice(sliced: _Sliced, length: float) -> Any:
    global _end
    _end = perf_counter() + length
    try:
        return sliced.switch()
    finally:
        _end = math.inf
