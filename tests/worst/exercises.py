"""The exercises of the search: the shipped ones, and exercises as a tutor might write them."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import DhTableSpec

from tests.frame_choice.robots import GIVEN, POLICIES, ROBOTS, exercise
from tests.shipped import shipped_exercises

# Robots that are in no shipped exercise are used if they have this many joints.
_JOINTS = 6


def exercises() -> Mapping[str, Exercise]:
    # Return all exercises by id; of those with a table, also a copy for both conventions.
    shipped = shipped_exercises()
    return {**shipped, **dict(_either(shipped)), **dict(_robots())}


def _either(shipped: Mapping[str, Exercise]) -> Iterator[tuple[str, Exercise]]:
    for name, each in shipped.items():
        parts = tuple(
            part.model_copy(update={"convention": "either"})
            if isinstance(part, DhTableSpec)
            else part
            for part in each.parts
        )
        if parts != each.parts:
            yield f"{name}-either", replace(each, id=f"{name}-either", parts=parts)


def _robots() -> Iterator[tuple[str, Exercise]]:
    for i, robot in enumerate(ROBOTS):
        if len(robot.joints) >= _JOINTS:
            for policy in (GIVEN, POLICIES[-1]):
                name = f"robot-{i}-{policy.name}".replace(" ", "-")
                yield name, replace(exercise(robot, policy), id=name)
