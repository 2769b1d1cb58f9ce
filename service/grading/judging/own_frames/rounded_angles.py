"""Angles that were written as rounded decimals, 1.57 for π/2, put back where they were meant.

Rounded angles lead nowhere exactly: nothing could be said of a student's frames, or of what is
missing. A robot whose own constant angles are all multiples of 15° has such angles in all the
frames that one would draw. So a decimal that is one of them as far as it goes stands for it: 2.094
for 2π/3, but not 2.0951.
"""

import re
from dataclasses import replace

import numpy as np

from service.catalogue import Exercise
from service.catalogue.robot import at_home
from service.grading.comparison import LARGEST_ANGLE, ROUNDED
from service.grading.joint_motion import changes
from service.grading.judging.own_frames.row_roles import Role, joint_cells
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import Samples
from service.kinematics.transforms import Numbers

STEP = np.pi / 12
SAME = 1e-9
_DECIMALS = re.compile(r"\.([0-9]*)")


def steadied(roles: tuple[Role, ...], exercise: Exercise, samples: Samples) -> tuple[Role, ...]:
    """The same roles with rounded angles made exact; ``as_written`` of their rows has the others.

    Where no angle was rounded they are the very same.
    """
    digits = np.array([_last_digits(role) for role in roles])
    if not digits.any() or not _turns_in_steps(exercise, samples):
        return roles
    nothing = np.full((len(IS_ANGLE), samples.count), np.nan)
    values = np.array([role.row.values if role.row else nothing for role in roles])
    off = _off_step(values, _variables(roles, samples), digits)
    exact = values - off[..., None]
    return tuple(
        replace(role, row=replace(role.row, values=exact[i], as_written=role.row.values))
        if role.row and off[i].any()
        else role
        for i, role in enumerate(roles)
    )


def _last_digits(role: Role) -> list[float]:
    """What 1 in the last digit written is worth, for each angle with a decimal; else 0."""
    entries = role.row.entries if role.row else ()
    return [
        _last_digit(entry.expression.source)
        if IS_ANGLE[column] and entry.may_be_rounded and entry.expression
        else 0.0
        for column, entry in enumerate(entries)
    ] or [0.0] * len(IS_ANGLE)


def _last_digit(text: str) -> float:
    return 10.0 ** -min(len(digits) for digits in _DECIMALS.findall(text))


def _off_step(values: Numbers, variables: Numbers, digits: Numbers) -> Numbers:
    """By how much the constant of each cell ``(rows, 4, SAMPLES)`` misses a step by being rounded.

    0 where it is more than rounding, or the cell is no constant beside its joint's variable.
    """
    senses = np.sign((changes(values) * changes(variables)).sum(axis=-1))
    rest = values - senses[..., None] * variables
    step = STEP * np.round(rest[..., 0] / STEP)
    off = rest[..., 0] - step
    # It may have been cut off or rounded, and then doubled.
    lost = np.minimum(2 * digits, ROUNDED * np.minimum(np.abs(step), LARGEST_ANGLE))
    near = (np.abs(off) <= lost) & (np.ptp(rest, axis=-1) < SAME)
    return np.where(near, off, 0.0)


def _variables(roles: tuple[Role, ...], samples: Samples) -> Numbers:
    """The joint variable that belongs in each cell, ``(rows, 4, samples)``; else 0."""
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
    return bool(np.abs(steps - np.round(steps)).max() < SAME)
