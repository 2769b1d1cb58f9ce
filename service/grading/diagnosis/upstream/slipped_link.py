"""The wrong link transforms that mistakes in one row of the table lead to."""

from collections.abc import Sequence

import numpy as np

from service.catalogue import Joint, ReferenceTable
from service.catalogue.robots.robot import at_home
from service.expressions.evaluation.samples import SymbolValues
from service.grading.diagnosis.upstream.joint_slips import axis_direction, joint_slips
from service.grading.diagnosis.upstream.length_slips import length_slips
from service.grading.diagnosis.upstream.slip import Change, change_cells, changed_values
from service.grading.diagnosis.upstream.slipped_answers import (
    AnswersAt,
    SlippedAnswers,
    slipped_tables,
)
from service.grading.diagnosis.upstream.table_slips import lengths_of, row_slips
from service.grading.judging.expected import as_entries
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.row_roles import variable_column
from service.grading.numerics.comparison import difference
from service.grading.numerics.joint_motion import changes
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.numerics.tolerances import SAME_MOTION
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import COLUMNS, Table, links
from service.kinematics.dh import Convention
from service.kinematics.dh_row import row as dh_row
from service.kinematics.transforms import Matrices, Numbers


def slipped_link(
    row: int, right: Matrices, convention: Convention, grading: Grading
) -> SlippedAnswers | None:
    """Return wrong link transforms that mistakes in one row lead to, or None."""
    # They are (K, 4, 4, samples); right is the correct transform (SAMPLES, 4, 4). None if the
    # answer is judged by an earlier answer of the student.
    if grading.following:
        return None
    samples = grading.samples
    table = grading.exercise.robot.tables[convention]
    cells = dh_row(right, convention)
    given = reference_values(table, samples)[row]
    axis = axis_direction(grading.exercise, samples.subset(1))
    of_joint = joint_slips(table.joints[row : row + 1], table.joints, axis)
    if np.abs(difference(cells, given, IS_ANGLE[:, None])).max() < SAME_MOTION:
        few = samples.subset(1)
        home = table.values(at_home(table.joints, few.values, few.count), few.count)[row]
        of_row = row_slips(table, row, home[:, 0].tolist(), axis)
        of_lengths = length_slips(*lengths_of(table))
        # A single row can hold another length in place of its own, but no exchange of two.
        single = (slip for slip in of_lengths if len(slip.symbols) == 1)
        return SlippedAnswers((*of_joint, *of_row, *single), _in_reference_frames(table, row))
    joint = table.joints[row] if row < len(table.joints) else None
    senses = _senses(cells, joint, samples)
    constants = cells - _motion(senses, joint, samples.values)
    of_row = row_slips(table, row, constants[:, 0].tolist(), axis, own_frames=True)
    at = _in_own_frames(row, constants, senses, joint, convention)
    return SlippedAnswers((*of_joint, *of_row), at, by_symbols=False)


def _in_reference_frames(table: ReferenceTable, row: int) -> AnswersAt:
    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        tables = slipped_tables(table, changes, samples.values, samples.count)
        return as_entries(links(tables[row : row + 1], table.convention)[0])

    return at


def _in_own_frames(
    row: int, constants: Numbers, senses: Numbers, joint: Joint | None, convention: Convention
) -> AnswersAt:
    # constants (4, SAMPLES) are the cells of the row with all joint variables 0.
    def at(changes: Sequence[Change], samples: Samples) -> Numbers:
        count = samples.count
        fixed = constants if count == SAMPLES else Samples.subset_of(constants, count // 2)
        moved = _motion(senses, joint, changed_values(changes, samples.values))
        right = fixed + _motion(senses, joint, samples.values)
        rows = np.repeat(fixed[:, None], len(changes), axis=1)
        rows += moved.reshape(4, -1, count) if joint else 0.0
        change_cells(changes, rows[None], right[None], fixed[None], first_row=row)
        return as_entries(links(rows[None], convention)[0])

    return at


def constants_and_motion(
    right: Matrices, convention: Convention, joints: Sequence[Joint], samples: Samples
) -> tuple[Table, Table]:
    """Return the DH rows of correct link transforms, split into constants and motion.

    The motion is the part of each cell that changes with the joints.
    """
    # right is (rows, SAMPLES, 4, 4). Both results are tables (rows, 4, SAMPLES), and the table is
    # their sum.
    constants, motions = np.empty((2, len(right), len(COLUMNS), samples.count))
    for i, link in enumerate(right):
        joint, cells = joints[i] if i < len(joints) else None, dh_row(link, convention)
        motions[i] = _motion(_senses(cells, joint, samples), joint, samples.values)
        constants[i] = cells - motions[i]
    return constants, motions


def _motion(senses: Numbers, joint: Joint | None, values: SymbolValues) -> Numbers:
    return np.multiply.outer(senses, values[joint.variable] if joint else np.zeros(1))


def _senses(cells: Numbers, joint: Joint | None, samples: Samples) -> Numbers:
    # The factor of the joint's variable in each cell of a row: 0, 1 or -1.
    senses = np.zeros(len(cells))
    if joint is not None:
        column = variable_column(joint)
        error = difference(
            changes(cells[column]), changes(samples.values[joint.variable]), not joint.prismatic
        )
        senses[column] = 1.0 if np.abs(error).max() < SAME_MOTION else -1.0
    return senses
