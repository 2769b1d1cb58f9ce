"""Convert the robots of shipped exercises to ``Robot``."""

import re
from functools import cache

from dh_grader.catalogue import Exercise

from tests.frame_choice.robots import Robot, TextRow
from tests.shipped import shipped_exercises, without_most_real_robots

_DEGREES = re.compile(r"(\d+(?:\.\d+)?)\s*deg")


@cache
def shipped_robots() -> tuple[Robot, ...]:
    """Return the robots of the shipped exercises, each once."""
    # Most real robots are left out: they have a campaign of their own (`tests.exercises.real`).
    found: dict[tuple[str, tuple[TextRow, ...]], Robot] = {}
    shipped = shipped_exercises()
    for name in without_most_real_robots(shipped):
        exercise = shipped[name]
        if any(part.kind == "dh_table" for part in exercise.parts):
            robot = robot_of(exercise)
            found.setdefault((robot.structure + robot.convention, robot.rows), robot)
    return tuple(found.values())


def robot_of(exercise: Exercise) -> Robot:
    """Convert the robot of an exercise to ``Robot``."""
    robot = exercise.robot
    rows = []
    for row in robot.tables[robot.convention].rows:
        a, alpha, d, theta = (_DEGREES.sub(r"(\1*pi/180)", cell.source) for cell in row)
        rows.append((a, alpha, d, theta))
    lengths = [each for each in exercise.variables if each.joint is None]
    return Robot(
        exercise.id,
        robot.structure,
        robot.convention.value,
        tuple(joint.variable for joint in robot.joints),
        tuple(rows),
        tuple(each.name for each in lengths),
        robot.joints[0].index,
        {each.name: (each.low, each.high) for each in lengths},
    )
