"""Measure one checkout once, and print each line of its benchmark as a ratio to the floor, as JSON.

``paired.py`` runs this file with the Python and in the folder of the checkout to be measured, which
may be an older one. So it uses nothing but that checkout's own ``tests.benchmarks``, and puts
other timers in the place of its own: they take processor time, and that of the floor in turn with
each call, so that a machine that is slow for a while is slow for both.
"""

import json
import sys
import time
from collections.abc import Callable
from statistics import median

from tests.benchmarks import __main__ as lines
from tests.benchmarks import floors, server

# So many times the rounds of ``make bench``, for differences of three per cent are to be seen.
MORE = 4
# Shorter than in ``make bench``: there are several rounds of this.
SECONDS_OF_POSTS = 1.0


def seconds(action: Callable[[], object]) -> float:
    """The processor time of one call, in which other programs have no part."""
    start = time.process_time()
    action()
    return time.process_time() - start


def floor() -> object:
    """The floor of ``make bench``."""
    return floors.stanford_pose(32)


def ratio_of_each(action: Callable[[int], object], rounds: int = 40) -> float:
    """The median time of ``action(i)``, as a multiple of the floor's, in thousandths."""
    for i in range(3):
        floor()
        action(-1 - i)
    floors_seconds, action_seconds = [], []
    for i in range(MORE * rounds):
        floors_seconds.append(seconds(floor))
        action_seconds.append(seconds(lambda i=i: action(i)))  # type: ignore[misc]
    return median(action_seconds) / median(floors_seconds) / 1e3


def ratio(action: Callable[[], object], rounds: int = 40) -> float:
    """The median time of one call, as a multiple of the floor's, in thousandths."""
    return ratio_of_each(lambda _: action(), rounds)


def in_process() -> dict[str, float]:
    """The lines that need no server; the first is the floor itself."""
    vars(lines).update(median_seconds=ratio, median_of_each=ratio_of_each)
    return {what: times for what, times, _ in lines.in_process()[1:]}


def over_http() -> dict[str, float]:
    """The lines that need a server: what a graded POST costs in trivial ones, and the start."""
    server.SECONDS = SECONDS_OF_POSTS
    figures = {}
    for what, bodies in server.BODIES.items():
        speed = server.posts_per_second(bodies)
        figures[f"graded POST, × a trivial one: {what}"] = speed["trivial"] / speed["graded"]
    floor_seconds = median(seconds(floor) for _ in range(1000))
    figures["first graded answer after start"] = server.first_answer_seconds() / floor_seconds
    return figures


if __name__ == "__main__":
    figures = in_process()
    if "--no-server" not in sys.argv:
        figures |= over_http()
    sys.stdout.write(json.dumps(figures))
