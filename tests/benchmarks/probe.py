"""Measure one checkout once, and print the times as JSON."""

# `paired.py` runs this file in the folder of the measured checkout, with the Python of that
# checkout. The benchmarks come from the measured checkout, which may be older; only the timing
# comes from the checkout of this file.

import json
import runpy
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.benchmarks import __main__ as lines
from tests.benchmarks import server

# Shorter than in ``make bench``, because this is measured in several rounds.
SECONDS_OF_POSTS = 3.0

TIMING = runpy.run_path(str(Path(__file__).with_name("timing.py")))


def in_process() -> dict[str, float]:
    if hasattr(lines, "BUDGETS"):
        return lines.in_process()
    # In an older checkout, this function returns milliseconds, with the floor as the first line.
    vars(lines).update(
        median_seconds=_thousandth_of(TIMING["multiple"]),
        median_of_each=_thousandth_of(TIMING["multiple_of_each"]),
    )
    older: Any = lines.in_process()
    return {what: times for what, times, _ in older[1:]}


def _thousandth_of(timer: Callable[[Callable[..., object]], float]) -> Callable[..., float]:
    return lambda action, _rounds=0: timer(action) / 1e3


def over_http() -> dict[str, float]:
    server.SECONDS = SECONDS_OF_POSTS
    figures = {}
    for what, bodies in server.BODIES.items():
        speed = server.posts_per_second(bodies)
        figures[f"graded POST, × a trivial one: {what}"] = speed["trivial"] / speed["graded"]
    figures["first graded answer after start"] = (
        server.first_answer_seconds() / TIMING["floor_seconds"]()
    )
    return figures


if __name__ == "__main__":
    figures = in_process()
    if "--no-server" not in sys.argv:
        figures |= over_http()
    sys.stdout.write(json.dumps(figures))
