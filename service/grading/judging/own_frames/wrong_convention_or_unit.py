"""The table that a student meant who mistook the convention, or the unit of all angles.

Such a slip makes most cells wrong at once. What was meant is known all the same, and so is what
each cell should be: nothing has to be guessed from which cells agree with some valid table.
"""

import numpy as np

from service.grading.judging.own_frames.few_cells import FrameReading, frames_from_reference
from service.grading.judging.own_frames.frame_freedom import Freedom
from service.grading.judging.own_frames.row_roles import Role
from service.grading.judging.own_frames.validity import valid_tables
from service.grading.judging.own_frames.written_table import (
    MISCONCEPTIONS,
    TOLERANCE,
    WrittenTable,
    written_table,
)
from service.grading.misconception import hypotheses_of
from service.grading.part import Grading
from service.kinematics.chain import Table, modified_rows, standard_rows
from service.kinematics.dh import Convention
from service.kinematics.frame_choice import WRONG_CELL

SAME = 1e-9


def read_as_meant(
    roles: tuple[Role, ...], convention: Convention, freedom: Freedom, grading: Grading
) -> FrameReading | None:
    """The table without one basic misconception, if that makes it valid; else None."""
    values = np.array([role.row.values for role in roles if role.row])
    if len(values) < len(roles) or not np.isfinite(values).all():
        return None
    exercise, samples = grading.exercise, grading.samples
    handed_in = written_table(values, convention, None, exercise.robot.joints, samples)
    for repaired in hypotheses_of(handed_in, MISCONCEPTIONS):
        table = repaired.answer
        valid = valid_tables(
            table.values[None], roles, table.convention, freedom, exercise, samples, TOLERANCE
        )
        meant = in_convention(table, convention) if valid[0] else None
        if meant is not None:
            apart = frames_from_reference(meant, roles, convention, grading)
            wrong = int(np.count_nonzero(np.abs(meant - values).max(axis=-1) > SAME))
            return FrameReading(roles, meant, apart, WRONG_CELL * max(1, wrong))
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
