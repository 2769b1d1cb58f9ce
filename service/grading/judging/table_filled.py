"""Replace numbers in a table, or empty cells."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from service.grading.judging.content import KnownCells, known_cells
from service.grading.judging.own_frames.best_roles import roles_in
from service.grading.judging.own_frames.nearest.spoiled_row import out_of_place
from service.grading.judging.own_frames.row_roles import joint_variables
from service.grading.numerics.samples import SAMPLES
from service.grading.part import Grading
from service.grading.reading.entry import Entry
from service.grading.reading.tables.table import (
    COMPUTED,
    EMPTY,
    GIVEN_UP,
    IS_ANGLE,
    StudentRow,
    StudentTable,
    computed_row,
)
from service.grading.report import Verdict
from service.kinematics.chain import Table
from service.kinematics.dh import Convention


def with_lazy_cells(answer: StudentTable, convention: Convention, grading: Grading) -> StudentTable:
    """Return the table with each empty or unreadable cell set to its joint variable or 0."""
    roles = roles_in(answer.rows, convention, grading, in_order=True)
    lazy = joint_variables([role.joint for role in roles], grading.samples)[: len(answer.rows)]
    return _filled(answer, np.asarray(np.isnan(answer.values).any(axis=-1)), lazy)


def with_wrong_cells(answer: StudentTable, cells: KnownCells, grading: Grading) -> StudentTable:
    """Return the table with wrong numbers in ``cells`` ``(rows, 4)``."""
    # The numbers are wrong whatever frames are chosen.
    numbers = out_of_place(len(answer.rows), grading.exercise.length_scale)
    return _filled(answer, cells, np.repeat(numbers, SAMPLES, axis=-1), GIVEN_UP)


def with_wrong_rows(answer: StudentTable, more: int, grading: Grading) -> StudentTable:
    """Return the table with ``more`` rows of wrong numbers at its end."""
    # The numbers are wrong whatever frames are chosen.
    rows = len(answer.rows)
    numbers = out_of_place(rows + more, grading.exercise.length_scale)[rows:]
    values = np.repeat(numbers, SAMPLES, axis=-1)
    given_up = tuple(computed_row(row, GIVEN_UP) for row in values)
    return replace(
        answer, rows=(*answer.rows, *given_up), values=np.concatenate([answer.values, values])
    )


def with_empty_cells(answer: StudentTable, cells: KnownCells) -> StudentTable:
    """Return the table without its entries in ``cells`` ``(rows, 4)``."""
    return _filled(answer, cells, np.full_like(answer.values, np.nan), EMPTY)


def written_content(answer: StudentTable, given: Sequence[bool], grading: Grading) -> int:
    """Return the number of cells in which the student wrote more than 0 or a joint variable.

    ``given`` marks the rows that the exercise gives; their cells are not counted.
    """
    values = answer.values[..., None, :: SAMPLES - 1]
    variables = [grading.samples.values[joint.variable] for joint in grading.exercise.joints]
    lazy = np.array([np.zeros(SAMPLES), *variables, *(-each for each in variables)])
    scales = np.where(IS_ANGLE, 1.0, grading.exercise.length_scale)[:, None]
    known = known_cells(values, lazy[:, :: SAMPLES - 1], scales, IS_ANGLE[:, None, None])
    written = (known | np.isnan(values).any(axis=-1)).all(axis=-1) & ~empty_cells(answer)
    if len(given) == len(written):
        written = written[~np.array(given)]
    return int(np.count_nonzero(written))


def with_zeros(answer: StudentTable) -> Table:
    """Return the numbers of the table, with 0 in empty cells."""
    return np.where(empty_cells(answer)[..., None], 0.0, answer.values)


def empty_cells(answer: StudentTable) -> KnownCells:
    """Return a mask ``(rows, 4)`` of the empty cells."""
    return np.array(
        [[entry.verdict is Verdict.MISSING for entry in row.entries] for row in answer.rows]
    )


def _filled(
    answer: StudentTable, cells: KnownCells, numbers: Table, filling: Entry = COMPUTED
) -> StudentTable:
    values = np.where(cells[..., None], numbers, answer.values)
    rows = tuple(
        StudentRow(
            tuple(
                filling if is_filled else entry
                for entry, is_filled in zip(row.entries, cells[i].tolist(), strict=True)
            ),
            values[i],
        )
        for i, row in enumerate(answer.rows)
    )
    return replace(answer, rows=rows, values=values)
