"""The way of an answer through the program gets shorter, and never longer.

``tests/way.py`` counts in a process of its own, so that no other test changes the counts.
"""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final

import pytest

from tests.way import ANSWERS

ROOT = Path(__file__).parents[1]
COUNTS: Final = ("files", "functions", "calls", "depth", "switches")

# Today's counts, in the order of COUNTS. They may only fall: a change that lowers one lowers it
# here, too.
TODAY: Final[Mapping[str, tuple[int, ...]]] = {
    "right": (17, 115, 482, 14, 197),
    "right, other frames": (21, 188, 753, 23, 282),
    "one wrong sign": (30, 390, 1548, 23, 550),
    "all twists wrong": (31, 533, 13914, 27, 3940),
    "right, pasted as CSV": (30, 283, 1931, 26, 772),
    "right, pasted as a toolbox script": (26, 229, 1927, 27, 852),
}
MODULES: Final = 138
# What is aimed at. The last test fails when a goal is reached, so that it becomes the ceiling.
GOALS: Final = {
    ("right", "files"): 14,
    ("right", "switches"): 120,
    ("right, other frames", "files"): 18,
    ("one wrong sign", "files"): 24,
    ("one wrong sign", "switches"): 400,
    ("one wrong sign", "depth"): 18,
}
POINTS: Final = {"one wrong sign": 10.25, "all twists wrong": 3.0}
FULL: Final = 12.0


@cache
def counted() -> Any:
    environment = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("DH_GRADER", "PYTHON", "COV"))
    }
    command = [sys.executable, "-m", "tests.way"]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", ANSWERS)
def test_the_way_of_an_answer_does_not_get_longer(name: str) -> None:
    way = counted()["ways"][name]
    assert way.pop("points") == POINTS.get(name, FULL)
    ceilings = dict(zip(COUNTS, TODAY[name], strict=True))
    assert {each: n for each, n in way.items() if n > ceilings[each]} == {}


def test_the_first_answer_imports_few_modules() -> None:
    found = counted()
    assert found["points"] == FULL
    assert found["modules"] <= MODULES


def test_a_goal_that_is_reached_becomes_the_ceiling() -> None:
    for (name, count), goal in GOALS.items():
        assert TODAY[name][COUNTS.index(count)] > goal, f"{name}: {count}"
