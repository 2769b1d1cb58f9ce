"""Fill the empty or unreadable cells of a table."""

from dataclasses import replace

import numpy as np

from service.grading.judging.content import KnownCells
from service.grading.judging.own_frames.best_roles import roles_in
from service.grading.judging.own_frames.nearest.spoiled_row import out_of_place
from service.grading.judging.own_frames.row_roles import joint_variables
from service.grading.numerics.samples import SAMPLES
from service.grading.part import Grading
from service.grading.reading.tables.table import COMPUTED, StudentRow, StudentTable
from service.grading.report import Verdict
from service.kinematics.chain import Table
from service.kinematics.dh import Convention


def with_lazy_cells(answer: StudentTable, convention: Convention, grading: Grading) -> StudentTable:
    """Return the table with the lazy entry in each cell without a value."""
    roles = roles_in(answer.rows, convention, grading, in_order=True)
    lazy = joint_variables([role.joint for role in roles], grading.samples)[: len(answer.rows)]
    return _filled(answer, np.asarray(np.isnan(answer.values).any(axis=-1)), lazy)


def with_wrong_cells(answer: StudentTable, grading: Grading) -> StudentTable | None:
    """Return the table with a wrong number in each empty cell; None if no cell is empty."""
    empty = _empty_cells(answer)
    if not empty.any():
        return None
    numbers = out_of_place(len(answer.rows), grading.exercise.length_scale)
    return _filled(answer, empty, np.repeat(numbers, SAMPLES, axis=-1))


def with_zeros(answer: StudentTable) -> Table:
    """Return the numbers of the table, with 0 in empty cells, so that their joints do not move."""
    return np.where(_empty_cells(answer)[..., None], 0.0, answer.values)


def _empty_cells(answer: StudentTable) -> KnownCells:
    return np.array(
        [[entry.verdict is Verdict.MISSING for entry in row.entries] for row in answer.rows]
    )


def _filled(answer: StudentTable, unread: KnownCells, numbers: Table) -> StudentTable:
    """Return the table with these numbers ``(rows, 4, SAMPLES)`` in the ``unread`` cells."""
    values = np.where(unread[..., None], numbers, answer.values)
    rows = tuple(
        StudentRow(
            tuple(
                COMPUTED if is_unread else entry
                for entry, is_unread in zip(row.entries, unread[i].tolist(), strict=True)
            ),
            values[i],
        )
        for i, row in enumerate(answer.rows)
    )
    return replace(answer, rows=rows, values=values)
