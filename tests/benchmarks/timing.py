"""Measure processor time in units of a fixed numpy computation."""

# Other programs do not count in processor time. Calls alternate with the floor, so that both are
# affected if the machine is slow for a while.

import time
from collections.abc import Callable
from statistics import median

from tests.benchmarks import floors

ROUNDS = 160
WARM_UP = 3


def floor() -> object:
    """Do the fixed computation that serves as the unit of time."""
    return floors.stanford_pose(32)


def seconds(action: Callable[[], object]) -> float:
    """Return the processor time of one call."""
    start = time.process_time()
    action()
    return time.process_time() - start


def floor_seconds() -> float:
    """Return the median processor time of ``floor()``."""
    return median(seconds(floor) for _ in range(1000))


def multiple(action: Callable[[], object]) -> float:
    """Return the median time of a call, divided by that of ``floor()``."""
    return multiple_of_each(lambda _: action())


def multiple_of_each(action: Callable[[int], object]) -> float:
    for i in range(WARM_UP):
        floor()
        action(-1 - i)
    of_floor, of_action = [], []
    for i in range(ROUNDS):
        of_floor.append(seconds(floor))
        of_action.append(seconds(lambda i=i: action(i)))  # type: ignore[misc]
    return median(of_action) / median(of_floor)
