"""Choose the next robot for a student who practises."""

import secrets
from collections.abc import Iterator
from dataclasses import replace

from service.catalogue import Exercise
from service.grading import FeedbackLevel, Submission, grade
from service.kinematics.dh import Convention
from service.variants.robots.difficulty import Situation, difficulty, situations
from service.variants.robots.generate import generated
from service.variants.robots.practice_id import PracticeId

# The first robot of a student is one of these: their ids are short.
_FIRST = 36**4
# How many robots are looked at; most levels have each situation in every third.
_MOST_LOOKS = 24
# The largest share of the points that a lazy answer may earn.
_MOST_FOR_NOTHING = 0.25


def first_robot(level: int, convention: Convention) -> PracticeId:
    """Return a random robot of a level."""
    return PracticeId(level, convention, secrets.randbelow(_FIRST))


def candidates(
    level: int, convention: Convention, after: PracticeId | None
) -> Iterator[PracticeId]:
    """Yield robots, one after the other, from which the caller takes the first suitable one."""
    # They begin after ``after``, or with a random robot. If none is suitable, the caller takes the
    # last. Many consecutive robots are all different.
    start = first_robot(level, convention) if after is None else after.following()
    start = replace(start, level=level, convention=convention)
    for steps in range(_MOST_LOOKS):
        yield start.following(steps)


def has_situation(name: PracticeId, favour: Situation) -> bool:
    """True if the robot has a situation that the student wants to practise."""
    return favour in situations(generated(name.level, name.number).plan)


def asks_enough(robot: Exercise) -> bool:
    """True if an answer of only zeros and joint variables earns little for a generated robot."""
    # For a few robots in a hundred, this answer earns more, and students do not get these robots as
    # the next robot. Which robots these are depends on the marking. A link to a robot must not
    # depend on the marking, so these robots exist nevertheless.
    [part] = robot.parts
    [table] = [robot.robot.tables[convention] for convention in robot.conventions]
    lazy = Submission({part.id: {"rows": table.lazy_rows}}, feedback=FeedbackLevel.SCORE)
    return grade(robot, lazy).score <= _MOST_FOR_NOTHING


def difficulty_of(name: PracticeId) -> int:
    """Return the difficulty of a robot as one number."""
    return difficulty(generated(name.level, name.number).plan).total
