"""The link transforms that slips in their own row lead to, in whatever frames the row is right."""

from collections.abc import Sequence

import numpy as np

from service.catalogue import Joint
from service.expressions.evaluation.samples import SymbolValues
from service.grading.comparison import difference
from service.grading.diagnosis.joint_slips import axis_direction, joint_slips
from service.grading.diagnosis.slip import Slip, change_cells, changed_values
from service.grading.diagnosis.slipped_answers import SlippedAnswers
from service.grading.diagnosis.table_slips import row_slips
from service.grading.joint_motion import changes
from service.grading.judging.expected import as_entries
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.row_roles import variable_column
from service.grading.part import Grading
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import SAMPLES, Samples
from service.grading.tolerances import SAME_MOTION
from service.kinematics.chain import links
from service.kinematics.dh import Convention
from service.kinematics.dh_row import row as dh_row
from service.kinematics.transforms import Matrices, Numbers


def slipped_link(
    row: int, right: Matrices, convention: Convention, grading: Grading
) -> SlippedAnswers | None:
    """The transforms ``(K, 4, 4, samples)`` of one row; ``right`` is ``(SAMPLES, 4, 4)``.

    None where the right one follows from the student's own answer.
    """
    if grading.following:
        return None
    exercise, samples = grading.exercise, grading.samples
    table = exercise.robot.tables[convention]
    cells = dh_row(right, convention)
    given = reference_values(table, samples)[row]
    own_frames = bool(np.abs(difference(cells, given, IS_ANGLE[:, None])).max() > SAME_MOTION)
    joint = table.joints[row] if row < len(table.joints) else None
    senses = _senses(cells, joint, samples)

    def motion(values: SymbolValues) -> Numbers:
        """By how much the joint moves each cell, ``(4, ...)``."""
        return np.multiply.outer(senses, values[joint.variable] if joint else np.zeros(1))

    constants = cells - motion(samples.values)

    def at(slips: Sequence[Slip], samples: Samples) -> Numbers:
        count = samples.count
        fixed = constants if count == SAMPLES else Samples.subset_of(constants, count // 2)
        moved = motion(changed_values(slips, samples.values))
        rows = np.repeat(fixed[:, None], len(slips), axis=1)
        rows += moved.reshape(4, -1, count) if joint else 0.0
        change_cells(slips, rows[None], fixed[None], first_row=row)
        return as_entries(links(rows[None], convention)[0])

    axis = axis_direction(exercise, samples.subset(1))
    slips = (
        *joint_slips(table.joints[row : row + 1], table.joints, axis),
        *row_slips(table, row, constants[:, 0].tolist(), axis, own_frames=own_frames),
    )
    return SlippedAnswers(slips, at)


def _senses(cells: Numbers, joint: Joint | None, samples: Samples) -> Numbers:
    """How often each cell ``(4, SAMPLES)`` contains the joint's variable: 0, 1 or −1."""
    senses = np.zeros(len(cells))
    if joint is not None:
        column = variable_column(joint)
        error = difference(
            changes(cells[column]), changes(samples.values[joint.variable]), not joint.prismatic
        )
        senses[column] = 1.0 if np.abs(error).max() < SAME_MOTION else -1.0
    return senses
