"""The next robot for a student."""

import secrets
from collections.abc import Iterator
from dataclasses import replace

from service.kinematics.dh import Convention
from service.variants.robots.difficulty import Situation, difficulty, situations
from service.variants.robots.generate import generated
from service.variants.robots.practice_id import PracticeId

# The first robot of a student is one of these: their ids are short.
_FIRST = 36**4
# How many robots are looked at for a situation; most levels have each situation in every third.
_MOST_LOOKS = 12


def first_robot(level: int, convention: Convention) -> PracticeId:
    """Return any robot of a level."""
    return PracticeId(level, convention, secrets.randbelow(_FIRST))


def candidates(
    level: int, convention: Convention, after: PracticeId | None, favour: Situation | None
) -> Iterator[PracticeId]:
    """Yield robots, of which the first with the situation ``favour`` is the next one.

    Among the robots after one another, no two are alike for a long time. Each look takes about a
    millisecond, so let other work be done between them. The last robot is taken in any case.
    """
    start = first_robot(level, convention) if after is None else after.following()
    start = replace(start, level=level, convention=convention)
    for steps in range(_MOST_LOOKS if favour else 1):
        yield start.following(steps)


def has_situation(name: PracticeId, favour: Situation) -> bool:
    """True if the robot has the situation."""
    return favour in situations(generated(name.level, name.number).plan)


def difficulty_of(name: PracticeId) -> int:
    """Return the difficulty of a robot as one number."""
    return difficulty(generated(name.level, name.number).plan).total
