"""The shipped exercises, loaded once in each process."""

from collections.abc import Iterable, Mapping
from functools import cache
from types import MappingProxyType

import pytest
from _pytest.mark import ParameterSet
from dh_grader.catalogue import Exercise, load_catalogue, shipped_folder

# The exercises with real robots, and those on the same arms in textbooks. They are much alike.
REAL_ROBOTS = (
    "abb-irb-120", "abb-irb-140", "abb-irb-6620lx", "adept-cobra-600", "anthropomorphic-arm",
    "fanuc-lr-mate-200id", "fanuc-m-10ia", "franka-research-3", "kinova-gen3", "kuka-kr-10-r1100",
    "kuka-kr-5-arc", "kuka-lbr-iiwa-7", "kuka-youbot-arm", "phantomx-pincher", "puma-560",
    "puma-560-craig", "sawyer", "spherical-arm", "staubli-tx2-90l", "ur10e", "ur16e", "ur20",
    "ur3e", "ur5e", "xarm6", "yaskawa-gp7",
)  # fmt: skip
# A modified table with a tool row, free directions, and a numeric pose.
_SAMPLE = ("franka-research-3", "kuka-kr-5-arc", "ur5e")


@cache
def shipped_exercises() -> Mapping[str, Exercise]:
    """Return the shipped exercises by id."""
    return MappingProxyType(load_catalogue(shipped_folder()))


def without_most_real_robots(ids: Iterable[str]) -> list[str]:
    # Return these ids of exercises without those of real robots, except for three.
    return [each for each in ids if each not in REAL_ROBOTS or each in _SAMPLE]


def sampled(ids: Iterable[str], one_in: int = 1) -> list[ParameterSet]:
    """Return parameters of a costly test; the suite runs only one in ``one_in``."""
    # The campaign runs it for all other ids, and for most of the real robots.
    ids = list(ids)
    kept = set(without_most_real_robots(ids)[::one_in])
    return [pytest.param(each, marks=() if each in kept else pytest.mark.campaign) for each in ids]


def one_of_each_kind() -> list[ParameterSet]:
    """Return parameters of a costly test; the suite runs it for a few exercises with all kinds."""
    # The campaign runs it for all other exercises.
    shipped = shipped_exercises()
    kept: list[str] = []
    missing = {part.kind for exercise in shipped.values() for part in exercise.parts}
    while missing:
        kept.append(
            max(
                shipped, key=lambda each: len(missing & {part.kind for part in shipped[each].parts})
            )
        )
        missing -= {part.kind for part in shipped[kept[-1]].parts}
    return [
        pytest.param(each, marks=() if each in kept else pytest.mark.campaign) for each in shipped
    ]
