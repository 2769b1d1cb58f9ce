"""Replace angles that are rounded decimals, such as 1.57 for π/2, by the exact angles.

In a robot whose constant angles are multiples of 15°, a decimal means such a multiple if all its
digits agree. So 2.094 means 2π/3, but 2.0951 does not.
"""

# A pose computed from rounded angles is not exactly valid, so that the student's frames or missing
# cells could not be found.

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
    """Replace rounded angles in the rows of ``roles`` by the exact angles.

    A changed row keeps the student's numbers in ``as_written``.
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
    """Return a mask ``(rows, 4)`` of the rounded angles whose exact values are known."""
    # These are all rounded angles if each of them agrees with a multiple of 15°, otherwise none: if
    # one angle of a table is not a multiple, another angle may look like one by chance.
    slack = _slack_of_angles(roles, exercise, samples)
    if slack is None:
        return np.zeros((len(roles), len(COLUMNS)), dtype=np.bool_)
    error = _rounding_errors(handed_in_values(roles), variables_of(roles, samples), slack)
    is_rounded = slack > 0
    return is_rounded & np.isfinite(error[is_rounded]).all()


def _slack_of_angles(
    roles: tuple[Role, ...], exercise: Exercise, samples: Samples
) -> Numbers | None:
    # None if no angle is rounded, or if the robot has angles that are not multiples of 15°.
    if not any(role.row.has_decimal for role in roles if role.row):
        return None
    slack = slack_of_cells(roles, samples, IS_ANGLE)
    return slack if slack.any() and _turns_in_steps(exercise, samples) else None


def slack_of_cells(
    roles: tuple[Role, ...], samples: Samples, columns: NDArray[np.bool_] = EVERY_COLUMN
) -> Numbers:
    """Return the largest possible rounding error of each cell."""
    # 0 outside ``columns``.
    slack = np.zeros((len(roles), len(COLUMNS)))
    for i, role in enumerate(roles):
        for column in np.flatnonzero(columns).tolist() if role.row else ():
            expression = role.row.entries[column].expression if role.row else None
            if expression is not None and expression.has_decimal:
                slack[i, column] = rounding_slack(expression, samples)
    return slack


def _rounding_errors(values: Numbers, variables: Numbers, slack: Numbers) -> Numbers:
    # NaN if the distance from a multiple of 15° is more than rounding can cause, or if the cell is
    # not a constant plus or minus its joint variable.
    signs = np.sign((changes(values) * changes(variables)).sum(axis=-1))
    constants = values - signs[..., None] * variables
    exact = STEP * np.round(constants[..., 0] / STEP)
    error = constants[..., 0] - exact
    is_rounded = (np.abs(error) <= slack) & (np.ptp(constants, axis=-1) < MULTIPLE_OF_STEP)
    return np.where(is_rounded, error, np.nan)


def _turns_in_steps(exercise: Exercise, samples: Samples) -> bool:
    def compute() -> bool:
        robot = exercise.robot
        values = at_home(robot.joints, samples.values, samples.count)
        table = robot.tables[robot.convention].values(values, samples.count)
        steps = table[:, IS_ANGLE] / STEP
        return bool(np.abs(steps - np.round(steps)).max() < MULTIPLE_OF_STEP)

    return samples.cached("turns in steps", compute)
