"""How a measurement is taken.

Everything is told as a multiple of the floor. It is processor time, in which other programs have no
part, and each call takes turns with the floor, so that a machine that is slow for a while is slow
for both.
"""

import time
from collections.abc import Callable
from statistics import median

from tests.benchmarks import floors

ROUNDS = 160
WARM_UP = 3


def floor() -> object:
    """The floor of ``make bench``."""
    return floors.stanford_pose(32)


def seconds(action: Callable[[], object]) -> float:
    """The processor time of one call."""
    start = time.process_time()
    action()
    return time.process_time() - start


def floor_seconds() -> float:
    """The median time of the floor."""
    return median(seconds(floor) for _ in range(1000))


def multiple(action: Callable[[], object]) -> float:
    """The median time of one call, as a multiple of the floor's."""
    return multiple_of_each(lambda _: action())


def multiple_of_each(action: Callable[[int], object]) -> float:
    """The median time of ``action(i)``, each call with another ``i``, as a multiple."""
    for i in range(WARM_UP):
        floor()
        action(-1 - i)
    of_floor, of_action = [], []
    for i in range(ROUNDS):
        of_floor.append(seconds(floor))
        of_action.append(seconds(lambda i=i: action(i)))  # type: ignore[misc]
    return median(of_action) / median(of_floor)
