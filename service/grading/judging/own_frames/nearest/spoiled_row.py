"""Replace the only wrong row of a table by numbers that are wrong in every cell.

A wrong row can mislead the search for the student's frames, so that correct rows look wrong.
"""

from typing import Final

import numpy as np

from service.grading.judging.own_frames.row_roles import Role, handed_in_values
from service.grading.numerics.comparison import nearly_equal
from service.grading.reading.tables.table import GIVEN_UP, IS_ANGLE, computed_row
from service.kinematics.chain import Table

# The fractional parts of its multiples are not angles or lengths of any robot.
OUT_OF_PLACE: Final = 0.3819660112501051


def out_of_place(rows: int, length_scale: float) -> Table:
    """Return numbers ``(rows, 4, 1)`` that are wrong in every cell of a table."""
    count = rows * len(IS_ANGLE)
    numbers = (OUT_OF_PLACE * np.arange(1, count + 1)) % 1 + OUT_OF_PLACE
    scales = np.where(IS_ANGLE, 1.0, length_scale)
    return np.asarray(numbers.reshape(rows, -1, 1) * scales[:, None])


def with_spoiled_row(
    roles: tuple[Role, ...], expected: Table, length_scale: float
) -> tuple[Role, ...] | None:
    """Replace the only row that differs from ``expected`` by wrong numbers, or return None."""
    # None if several rows differ, if the row is missing, or if it was replaced before.
    handed_in, scales = handed_in_values(roles), np.where(IS_ANGLE, 1.0, length_scale)
    right = nearly_equal(handed_in, expected, scales, IS_ANGLE[:, None]).all(axis=1)
    wrong = np.flatnonzero(~right).tolist()
    if len(wrong) != 1:
        return None
    [i] = wrong
    row = roles[i].row
    if row is None or row.is_given_up:
        return None
    numbers = np.broadcast_to(out_of_place(len(roles), length_scale), handed_in.shape)
    spoiled = Role(computed_row(numbers[i], GIVEN_UP), roles[i].joint)
    return (*roles[:i], spoiled, *roles[i + 1 :])
