"""Angles that were written as rounded decimals, 1.57 for π/2, replaced by the exact angle.

A pose that is computed from rounded angles is no valid one, and nothing could be said of the
student's frames or of what is missing. If the constant angles of a robot are all multiples of 15°,
so are the angles in all the frames that one would draw. Then a decimal that is such a multiple to
its last digit stands for it: 2.094 for 2π/3, but not 2.0951.
"""

import re
from dataclasses import replace

import numpy as np

from service.catalogue import Exercise
from service.catalogue.robot import at_home
from service.grading.joint_motion import changes
from service.grading.judging.own_frames.row_roles import Role, handed_in_values, variables_of
from service.grading.reading.entry import Entry
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import Samples
from service.grading.tolerances import MULTIPLE_OF_STEP, ROUNDED_VALUE
from service.kinematics.tolerances import LARGEST_ANGLE
from service.kinematics.transforms import Numbers

STEP = np.pi / 12
_DECIMALS = re.compile(r"\.([0-9]*)")


def with_exact_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> tuple[Role, ...]:
    """The same roles with rounded angles made exact; ``as_written`` of their rows has the others.

    Where no angle was rounded, the result is ``roles`` itself.
    """
    digits = IS_ANGLE * [
        list(map(_last_digit, role.row.entries)) if role.row else [0.0] * 4 for role in roles
    ]
    if not digits.any() or not _turns_in_steps(exercise, samples):
        return roles
    values = handed_in_values(roles)
    error = _rounding_errors(values, variables_of(roles, samples), digits)
    exact = values - error[..., None]
    return tuple(
        replace(role, row=replace(role.row, values=exact[i], as_written=role.row.values))
        if role.row and error[i].any()
        else role
        for i, role in enumerate(roles)
    )


def _last_digit(entry: Entry) -> float:
    """The value of 1 in the last digit written, if the entry has a decimal; else 0."""
    if not (entry.may_be_rounded and entry.expression):
        return 0.0
    return 10.0 ** -min(map(len, _DECIMALS.findall(entry.expression.source)))


def _rounding_errors(values: Numbers, variables: Numbers, digits: Numbers) -> Numbers:
    """By how much rounding took each cell ``(rows, 4, SAMPLES)`` off a multiple of the step.

    0 where the cell is off by more than rounding, or is not its joint's variable and a constant.
    """
    signs = np.sign((changes(values) * changes(variables)).sum(axis=-1))
    constants = values - signs[..., None] * variables
    exact = STEP * np.round(constants[..., 0] / STEP)
    error = constants[..., 0] - exact
    # The last digit may have been cut off or rounded, and the number then doubled.
    largest = np.minimum(2 * digits, ROUNDED_VALUE * np.minimum(np.abs(exact), LARGEST_ANGLE))
    is_rounded = (np.abs(error) <= largest) & (np.ptp(constants, axis=-1) < MULTIPLE_OF_STEP)
    return np.where(is_rounded, error, 0.0)


def _turns_in_steps(exercise: Exercise, samples: Samples) -> bool:
    """Whether the reference's constant angles are multiples of the step."""

    def compute() -> bool:
        robot = exercise.robot
        values = at_home(robot.joints, samples.values, samples.count)
        table = robot.tables[robot.convention].values(values, samples.count)
        steps = table[:, IS_ANGLE] / STEP
        return bool(np.abs(steps - np.round(steps)).max() < MULTIPLE_OF_STEP)

    return samples.cached("turns in steps", compute)
