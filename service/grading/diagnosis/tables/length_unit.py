"""Tables whose lengths are in a wrong unit, such as millimetres instead of metres."""

from dataclasses import replace
from typing import Final

import numpy as np

from service.grading.diagnosis.tables.intended_table import IntendedTable
from service.grading.diagnosis.wording import UNIT_FACTORS, other_length_unit
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.written_table import written_table
from service.grading.misconception import register
from service.grading.part import Grading
from service.grading.reading.tables.table import (
    COMPUTED,
    IS_ANGLE,
    StudentRow,
    StudentTable,
    values_of,
)
from service.kinematics.dh import Convention
from service.translations import template

# Between two units. The lengths of other frames differ, too, but not by so much.
_HALFWAY: Final = 10**0.5
# With fewer lengths, any number could be a length in another unit.
_LEAST_LENGTHS: Final = 2
_OTHER_UNIT = register(
    of=StudentTable,
    code="other_length_unit",
    rule="link_length",
    means=template("all lengths are in another unit, such as millimetres instead of metres"),
    example=(
        "ur5e",
        "table",
        (
            "0, 90°, 162.5, theta1 ↵ -425, 0, 0, theta2 ↵ -392.2, 0, 0, theta3 ↵ 0, 90°, 133.3, "
            "theta4 ↵ 0, -90°, 99.7, theta5 ↵ 0, 0, 99.6, theta6"
        ),
    ),
    unlike={"1/d": "162.5", "2/a": "-425"},
)


def in_other_length_unit(
    table: StudentTable, convention: Convention | None, grading: Grading
) -> IntendedTable | None:
    """Return the table with its lengths in the unit of the exercise, or None."""
    # The size of the lengths shows in which unit they were written. Joint variables are not
    # converted.
    robot = grading.exercise.robot
    reference = robot.tables.get(convention or robot.convention)
    if reference is None or not np.isfinite(table.values).all():
        return None
    right = np.abs(reference_values(reference, grading.samples)[:, ~IS_ANGLE]).max()
    written = written_table(
        table.values, reference.convention, None, robot.joints, grading.samples
    ).constants
    lengths = np.abs(written).max(axis=-1) * ~IS_ANGLE
    times = _times(lengths.max(), right)
    cells = np.argwhere(lengths > 0).tolist()
    if times is None or len(cells) < _LEAST_LENGTHS:
        return None
    rows = list(table.rows)
    for i, column in cells:
        entries, values = list(rows[i].entries), rows[i].values.copy()
        # The decimals of the entry are not those of the converted number.
        entries[column] = COMPUTED
        values[column] += written[i, column] * (1 / times - 1)
        rows[i] = StudentRow(tuple(entries), values)
    intended = replace(table, rows=tuple(rows), values=values_of(rows))
    finding = replace(other_length_unit(times), code=_OTHER_UNIT.code, rule=_OTHER_UNIT.rule)
    return IntendedTable(intended, finding, frozenset((i, j) for i, j in cells))


def _times(largest: float, right: float) -> float | None:
    # The power of ten by which the lengths are too large, or None if they are not.
    for times in UNIT_FACTORS:
        if right / _HALFWAY < largest / times < right * _HALFWAY:
            return times
    return None
