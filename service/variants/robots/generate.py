"""Generate a robot from a level and a number."""

# Random robots are drawn until one is acceptable.

from dataclasses import dataclass
from typing import Final

from service.variants.robots.draws import Draws
from service.variants.robots.geometry.home_path import HomePath, home_path
from service.variants.robots.geometry.refusals import Seen, clear_view, reason_against
from service.variants.robots.geometry.skeleton import DIFFERENT, skeleton
from service.variants.robots.level import LEVELS, Grammar
from service.variants.robots.plan import Plan, plan, plan_along

_TRIES: Final = 1000
# After this number of refusals, a simple robot gets the next directions.
_TRIES_OF_A_SKELETON: Final = 18
# Levels at which directions are counted off.
_SIMPLE: Final = 2


@dataclass(frozen=True, slots=True)
class Generated:
    """A generated robot, the path of its links, and the view in its figure."""

    plan: Plan
    path: HomePath
    view: Seen


def generated(level: int, number: int) -> Generated:
    """Return the robot with this number. Equal arguments give equal robots on every machine."""
    rules = LEVELS[level]
    for attempt in range(_TRIES):
        draws = Draws(f"robot {level} {number} {attempt}")
        drawn = _simple(rules, number, attempt, draws) if level <= _SIMPLE else plan(rules, draws)
        if drawn is None:
            continue
        path = home_path(drawn.rows)
        if reason_against(drawn, path) is None and (view := clear_view(path)):
            return Generated(drawn, path, view)
    raise AssertionError(f"no robot of level {level} has the number {number}")


def _simple(rules: Grammar, number: int, attempt: int, draws: Draws) -> Plan | None:
    shape = skeleton(rules, number + DIFFERENT * (attempt // _TRIES_OF_A_SKELETON))
    return None if shape is None else plan_along(shape, rules, draws)
