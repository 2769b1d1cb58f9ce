"""The intended table of a student who mistook the convention, or the unit of all angles.

Such a slip makes most cells wrong at once. The intended table is known all the same, and so is the
right value of each cell: nothing has to be guessed from the cells that agree with some valid table.
"""

import numpy as np

from service.grading.judging.own_frames.few_cells import NearestTable, frames_from_reference
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role
from service.grading.judging.own_frames.validity import valid_tables
from service.grading.judging.own_frames.written_table import (
    MISCONCEPTIONS,
    WrittenTable,
    written_table,
)
from service.grading.misconception import hypotheses_of
from service.grading.part import Grading
from service.grading.tolerances import INTENDED_POSE, UNCHANGED_CELL
from service.kinematics.chain import Table, modified_rows, standard_rows
from service.kinematics.dh import Convention
from service.kinematics.frame_choice import WRONG_CELL


def nearest_as_intended(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable | None:
    """The table without one basic misconception, if that makes it valid; else None."""
    values = np.array([role.row.values for role in roles if role.row])
    if len(values) < len(roles) or not np.isfinite(values).all():
        return None
    exercise, samples = grading.exercise, grading.samples
    handed_in = written_table(values, convention, None, exercise.robot.joints, samples)
    for repaired in hypotheses_of(handed_in, MISCONCEPTIONS):
        table = repaired.answer
        [valid] = valid_tables(
            table.values[None], roles, table.convention, freedom, exercise, samples, INTENDED_POSE
        )
        intended = in_convention(table, convention) if valid else None
        if intended is not None:
            frames = frames_from_reference(intended, roles, convention, grading)
            changed = np.abs(intended - values).max(axis=-1) > UNCHANGED_CELL
            cost = WRONG_CELL * max(1, int(np.count_nonzero(changed)))
            return NearestTable(roles, intended, frames, cost)
    return None


def in_convention(table: WrittenTable, convention: Convention) -> Table | None:
    """The same chain in a convention, ``(rows, 4, samples)``; None where that takes other rows."""
    values = table.values
    if table.convention is convention:
        return values
    rows = [(row[0], row[1], row[2], row[3]) for row in values]
    zero = np.zeros(values.shape[-1])
    if convention is Convention.STANDARD:
        left_out, moved = values[0, :2], standard_rows(rows, zero)
    else:
        *moved, last = modified_rows(rows, zero)
        left_out = np.array(last)
    return None if left_out.any() else np.array(moved)
