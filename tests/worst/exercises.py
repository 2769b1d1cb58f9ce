"""The exercises that may be attacked: the shipped ones, and others that a tutor may write."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from service.catalogue import Exercise
from service.catalogue.parts.dh_table import DhTableSpec
from tests.frame_choice.robots import GIVEN, POLICIES, ROBOTS, exercise
from tests.shipped import shipped_exercises

# Of the robots that are shipped as no exercise, those with the most joints.
_JOINTS = 6


def exercises() -> Mapping[str, Exercise]:
    """All exercises by id; of those with a table, also one that may be in either convention."""
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
