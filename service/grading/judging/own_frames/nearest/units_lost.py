"""Estimate the loss of points for wrong cells."""

import numpy as np
from numpy.typing import NDArray

from service.grading.judging.marking.worth import BESIDES
from service.grading.numerics.comparison import difference
from service.grading.numerics.tolerances import SAME_CONTENT
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import Table


def units_lost(
    expected: Table, variables: Table, wrong: NDArray[np.bool_], length_scale: float
) -> float:
    """Return the estimated loss for the ``wrong`` cells; a single wrong cell costs 1."""
    # Several wrong cells in one row lose no more than the row is worth. ``expected`` ``(rows, 4,
    # samples)`` is the correct table. ``variables`` is the joint variable that belongs in each
    # cell, or 0.
    either = np.array([expected - variables, expected + variables])
    error = np.abs(difference(either, np.zeros(1), IS_ANGLE[:, None])).max(axis=-1).min(axis=0)
    known = error > SAME_CONTENT * np.where(IS_ANGLE, 1.0, length_scale)
    worth, count = BESIDES + known.sum(axis=1), wrong.sum(axis=1)
    return float(np.where(count > 1, np.minimum(worth, count), count).sum())
