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
from service.grading.judging.own_frames.row_roles import Role, joint_cells
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
    digits = np.array([_last_digits(role) for role in roles])
    if not digits.any() or not _turns_in_steps(exercise, samples):
        return roles
    nothing = np.full((len(IS_ANGLE), samples.count), np.nan)
    values = np.array([role.row.values if role.row else nothing for role in roles])
    error = _rounding_errors(values, _variables(roles, samples), digits)
    exact = values - error[..., None]
    return tuple(
        replace(role, row=replace(role.row, values=exact[i], as_written=role.row.values))
        if role.row and error[i].any()
        else role
        for i, role in enumerate(roles)
    )


def _last_digits(role: Role) -> list[float]:
    """The value of 1 in the last digit written, for each angle with a decimal; else 0."""
    entries = role.row.entries if role.row else ()
    return [
        _last_digit(entry.expression.source)
        if IS_ANGLE[column] and entry.may_be_rounded and entry.expression
        else 0.0
        for column, entry in enumerate(entries)
    ] or [0.0] * len(IS_ANGLE)


def _last_digit(text: str) -> float:
    return 10.0 ** -min(len(digits) for digits in _DECIMALS.findall(text))


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


def _variables(roles: tuple[Role, ...], samples: Samples) -> Numbers:
    """The joint variable that belongs in each cell, ``(rows, 4, samples)``; 0 in the others."""
    variables = np.zeros((len(roles), len(IS_ANGLE), samples.count))
    for cell, joint in joint_cells(roles).items():
        variables[cell] = samples.values[joint.variable]
    return variables


def _turns_in_steps(exercise: Exercise, samples: Samples) -> bool:
    """Whether the reference's constant angles are multiples of the step."""
    return samples.cached("turns in steps", lambda: _in_steps(exercise, samples))


def _in_steps(exercise: Exercise, samples: Samples) -> bool:
    robot = exercise.robot
    values = at_home(robot.joints, samples.values, samples.count)
    table = robot.tables[robot.convention].values(values, samples.count)
    steps = table[:, IS_ANGLE] / STEP
    return bool(np.abs(steps - np.round(steps)).max() < MULTIPLE_OF_STEP)
