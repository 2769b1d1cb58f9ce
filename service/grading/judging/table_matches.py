"""How each cell of a table matches the value that is expected there."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.comparison import Match, difference, matches, same
from service.grading.joint_motion import changes
from service.grading.judging.own_frames.row_roles import variable_column
from service.grading.part import Grading
from service.grading.reading.table import IS_ANGLE
from service.grading.tolerances import HUGE_CELL, HUGE_LENGTH, SAME_MOTION
from service.kinematics.chain import Table
from service.kinematics.transforms import Numbers


def column_scales(grading: Grading) -> Numbers:
    """The scale of each column: the unit of its tolerances."""
    return np.where(IS_ANGLE, 1.0, grading.exercise.length_scale)


def table_matches(
    actual: Table,
    expected: Table,
    rounded: Sequence[Sequence[bool]],
    joints: Sequence[Joint | None],
    grading: Grading,
) -> NDArray[np.int_]:
    """The Match of each cell, ``(rows, 4)``, of tables ``(rows, 4, SAMPLES)``.

    ``rounded`` ``(rows, 4)`` says which cells hold a number that may be rounded, ``joints`` which
    joint each row is for.
    """
    angle, scales = IS_ANGLE[:, None], column_scales(grading)
    found = matches(actual, expected, scales, angle, rounded)
    for i, column in np.argwhere(found == Match.ROUNDED).tolist():
        cells = actual[i, column], expected[i, column]
        if not _is_rounded(*cells, column, joints[i], grading):
            found[i, column] = Match.DIFFERENT
    if np.abs(expected[..., 0]).max() > HUGE_LENGTH * grading.exercise.length_scale:
        # A student's own large offset must not widen what is let through.
        error = np.abs(difference(actual, expected, angle)).max(axis=-1)
        too_far = (found == Match.EXACT) & (error > HUGE_CELL * scales)
        found = np.where(too_far, int(Match.DIFFERENT), found)
    return found


def _is_rounded(
    actual: Numbers, expected: Numbers, column: int, joint: Joint | None, grading: Grading
) -> bool:
    """Whether a cell that is nearly right has a rounded constant and moves as it should."""
    angle = bool(IS_ANGLE[column])
    if not _moves_as(actual, expected, angle):
        return False
    if joint is None or column != variable_column(joint):
        return True
    variable = grading.samples.values[joint.variable]
    if not _moves_as(expected, variable, angle):
        variable = -variable
    scale = float(column_scales(grading)[column])
    return same(actual - variable, expected - variable, scale, angle)


def _moves_as(one: Numbers, other: Numbers, angle: bool) -> bool:
    error = np.abs(difference(changes(one), changes(other), angle))
    return bool(error.max() < SAME_MOTION)
