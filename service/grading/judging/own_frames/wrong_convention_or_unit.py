"""The intended table of a student who mistook the convention, or the unit of all angles.

Such a slip makes most cells wrong at once. The intended table is known all the same, and so is the
right value of each cell: nothing has to be guessed from the cells that agree with some valid table.
"""

import numpy as np

from service.grading.judging.own_frames.few_cells import NearestTable, frames_from_reference
from service.grading.judging.own_frames.reference import as_table, regrouped
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role, handed_in_values
from service.grading.judging.own_frames.validity import valid_tables
from service.grading.judging.own_frames.written_table import (
    MISCONCEPTIONS,
    WrittenTable,
    written_table,
)
from service.grading.misconception import hypotheses_of
from service.grading.part import Grading
from service.grading.tolerances import INTENDED_POSE, UNCHANGED_CELL
from service.kinematics.chain import Table
from service.kinematics.dh import Convention
from service.kinematics.frame_choice import WRONG_CELL


def nearest_as_intended(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable | None:
    """The table without one basic misconception, if that makes it valid; else None."""
    values = handed_in_values(roles)
    if not np.isfinite(values).all():
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
    links = regrouped(table.values, table.convention, 0.0)
    left_out = links[0] if convention is Convention.STANDARD else links[-1, :2]
    return None if left_out.any() else as_table(links, convention)
