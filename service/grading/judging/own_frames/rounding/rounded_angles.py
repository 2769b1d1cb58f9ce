"""Angles that were written as rounded decimals, 1.57 for π/2, replaced by the exact angle.

A pose that is computed from rounded angles is no valid one, and nothing could be said of the
student's frames or of what is missing. If the constant angles of a robot are all multiples of 15°,
so are the angles in all the frames that one would draw. Then a decimal that is such a multiple to
its last digit stands for it: 2.094 for 2π/3, but not 2.0951.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise
from service.catalogue.robots.robot import at_home
from service.grading.judging.own_frames.row_roles import Role, handed_in_values, variables_of
from service.grading.numerics.comparison import rounding_slack
from service.grading.numerics.joint_motion import changes
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import MULTIPLE_OF_STEP
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import COLUMNS
from service.kinematics.transforms import Numbers

STEP = np.pi / 12
EVERY_COLUMN = np.ones(len(COLUMNS), dtype=np.bool_)


def with_exact_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> tuple[Role, ...]:
    """The same roles with rounded angles made exact; ``as_written`` of their rows has the others.

    Where no angle was rounded, the result is ``roles`` itself.
    """
    slack = _slack_of_angles(roles, exercise, samples)
    if slack is None:
        return roles
    values = handed_in_values(roles)
    error = _rounding_errors(values, variables_of(roles, samples), slack)
    error = np.nan_to_num(error)
    exact = values - error[..., None]
    return tuple(
        replace(role, row=replace(role.row, values=exact[i], as_written=role.row.values))
        if role.row and error[i].any()
        else role
        for i, role in enumerate(roles)
    )


def known_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> NDArray[np.bool_]:
    """Which cells ``(rows, 4)`` are rounded angles of which the exact values are known.

    These are all rounded angles, if each of them stands for a multiple of the step, and else none:
    of frames in which one angle is no such multiple, another may only look like one.
    """
    slack = _slack_of_angles(roles, exercise, samples)
    if slack is None:
        return np.zeros((len(roles), len(COLUMNS)), dtype=np.bool_)
    error = _rounding_errors(handed_in_values(roles), variables_of(roles, samples), slack)
    is_rounded = slack > 0
    return is_rounded & np.isfinite(error[is_rounded]).all()


def _slack_of_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> Numbers | None:
    """The slack of the rounded angles; None if there are none, or they may be any angles."""
    if not any(role.row.has_decimal for role in roles if role.row):
        return None
    slack = slack_of_cells(roles, samples, IS_ANGLE)
    return slack if slack.any() and _turns_in_steps(exercise, samples) else None


def slack_of_cells(
    roles: tuple[Role, ...], samples: Samples, columns: NDArray[np.bool_] = EVERY_COLUMN
) -> Numbers:
    """By how much rounding may have moved each cell of these columns, ``(rows, 4)``; else 0."""
    slack = np.zeros((len(roles), len(COLUMNS)))
    for i, role in enumerate(roles):
        for column in np.flatnonzero(columns).tolist() if role.row else ():
            expression = role.row.entries[column].expression if role.row else None
            if expression is not None and expression.has_decimal:
                slack[i, column] = rounding_slack(expression, samples)
    return slack


def _rounding_errors(values: Numbers, variables: Numbers, slack: Numbers) -> Numbers:
    """By how much rounding took each cell ``(rows, 4, SAMPLES)`` off a multiple of the step.

    NaN where it is off by more, or the cell is not its joint's variable and a constant.
    """
    signs = np.sign((changes(values) * changes(variables)).sum(axis=-1))
    constants = values - signs[..., None] * variables
    exact = STEP * np.round(constants[..., 0] / STEP)
    error = constants[..., 0] - exact
    is_rounded = (np.abs(error) <= slack) & (np.ptp(constants, axis=-1) < MULTIPLE_OF_STEP)
    return np.where(is_rounded, error, np.nan)


def _turns_in_steps(exercise: Exercise, samples: Samples) -> bool:
    """Whether the reference's constant angles are multiples of the step."""

    def compute() -> bool:
        robot = exercise.robot
        values = at_home(robot.joints, samples.values, samples.count)
        table = robot.tables[robot.convention].values(values, samples.count)
        steps = table[:, IS_ANGLE] / STEP
        return bool(np.abs(steps - np.round(steps)).max() < MULTIPLE_OF_STEP)

    return samples.cached("turns in steps", compute)
