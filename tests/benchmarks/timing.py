"""How a measurement is taken."""

import time
from collections.abc import Callable
from statistics import median

ROUNDS = 40


def median_seconds(action: Callable[[], object], rounds: int = ROUNDS) -> float:
    """The median time of one call, after a warm-up."""
    for _ in range(3):
        action()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return median(times)


def median_of_each(action: Callable[[int], object], rounds: int = ROUNDS) -> float:
    """The median time of ``action(i)``, each call with another ``i``."""
    for i in range(3):
        action(-1 - i)
    times = []
    for i in range(rounds):
        start = time.perf_counter()
        action(i)
        times.append(time.perf_counter() - start)
    return median(times)
