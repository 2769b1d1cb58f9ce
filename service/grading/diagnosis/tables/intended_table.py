"""A student's table with one systematic mistake corrected."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from service.grading.diagnosis.tables.whole_table import exchanged_columns
from service.grading.feedback import Finding
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.table import column_scales
from service.grading.numerics.comparison import nearly_equal
from service.grading.part import Grading
from service.grading.reading.tables.table import StudentRow, StudentTable, values_of
from service.kinematics.chain import A, D
from service.kinematics.dh import Convention
from service.kinematics.factors import CellIndex

_EXCHANGED = [D, 1, A, 3]


class IntendedTable(NamedTuple):
    """A student's table with one systematic mistake corrected."""

    table: StudentTable
    # Describes the mistake.
    finding: Finding
    # The cells that have the mistake.
    cells: frozenset[CellIndex]


def with_exchanged_row(
    table: StudentTable, convention: Convention | None, grading: Grading
) -> IntendedTable | None:
    """Return the table with a and d exchanged in one row, if that corrects both cells."""
    # None unless there is exactly one such row.
    robot = grading.exercise.robot
    reference = robot.tables.get(convention or robot.convention)
    if reference is None or len(reference.rows) != len(table.rows):
        return None
    expected = reference_values(reference, grading.samples)[:, [A, D]]
    written, scale = table.values[:, [A, D]], column_scales(grading)[A]
    as_read = nearly_equal(written, expected, scale, False)
    exchanged = nearly_equal(written[:, ::-1], expected, scale, False)
    found = np.flatnonzero(exchanged.all(axis=-1) & ~as_read.any(axis=-1)).tolist()
    if len(found) != 1:
        return None
    [i] = found
    rows = list(table.rows)
    rows[i] = StudentRow(
        tuple(rows[i].entries[column] for column in _EXCHANGED), rows[i].values[_EXCHANGED]
    )
    intended = replace(table, rows=tuple(rows), values=values_of(rows))
    return IntendedTable(intended, exchanged_columns(A, D), frozenset({(i, A), (i, D)}))
