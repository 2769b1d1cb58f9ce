"""The check that every joint of the reference robot adds a motion."""

from collections.abc import Iterator

import numpy as np

from service.authoring.remarks import Remark, warning
from service.catalogue import Exercise
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.robots.variables import TRIALS, trial_values
from service.kinematics.jacobian import coincident, rank
from service.kinematics.screws import exponential, moved
from service.kinematics.transforms import Numbers, identity
from service.translations import say, template

WAYS = 6


def lost_freedom(exercise: Exercise) -> Iterator[Remark]:
    """Yield warnings about joints that add no motion."""
    robot = exercise.reference
    if robot is None:
        return
    jacobian = _jacobian(exercise, robot)
    pairs = np.argwhere(np.triu(coincident(jacobian)))
    for i, j in pairs.tolist():
        one, other = robot.joints[i], robot.joints[j]
        motion = (
            template(
                "joints {first} and {second} slide in one direction, so the arm has lost a degree "
                "of freedom; check the rows between them"
            )
            if one.prismatic
            else template(
                "joints {first} and {second} turn about one line, so the arm has lost a degree of "
                "freedom; check the rows between them"
            )
        )
        yield warning("robot", say(motion, first=one.index, second=other.index))
    ways, joints = rank(jacobian), len(robot.joints)
    if ways < min(joints, WAYS) and not len(pairs):
        yield warning(
            "robot",
            say(
                "the {joints} joints move the tool in {ways} ways only, in every "
                "configuration; check the rows, or say in the statement that the arm is "
                "redundant",
                joints=joints,
                ways=ways,
            ),
        )


def _jacobian(exercise: Exercise, robot: Reference) -> Numbers:
    # Source: Lynch and Park, *Modern Robotics*, eq. 5.11.
    values = trial_values(exercise.variables)
    reached = identity((TRIALS,))
    columns = []
    for joint, axis in zip(robot.joints, robot.screws(values, TRIALS), strict=True):
        column = moved(reached, axis)
        if not joint.prismatic:
            column[:, 3:] /= exercise.length_scale
        columns.append(column)
        reached = reached @ exponential(axis, values[joint.variable])
    return np.stack(columns, axis=-1)
