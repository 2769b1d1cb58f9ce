"""Separate a submitted table into constants and joint variables."""

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.judging.own_frames.reference import regrouped
from service.grading.judging.own_frames.rounding.rounded_angles import slack_of_cells
from service.grading.judging.own_frames.row_roles import (
    Role,
    handed_in_values,
    joint_cells,
    variable_column,
)
from service.grading.numerics.comparison import difference
from service.grading.numerics.joint_motion import halves, joint_counts
from service.grading.numerics.samples import HALF, SAMPLES, Samples
from service.grading.numerics.tolerances import SAME_MOTION
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention
from service.kinematics.frames.chain_match import RowConstants
from service.kinematics.transforms import Numbers


def row_constants(
    roles: tuple[Role, ...], joints: tuple[Joint, ...], convention: Convention, samples: Samples
) -> list[RowConstants]:
    """Return the constants of a table, regrouped into rows between neighbouring joint axes."""
    # A cell that depends wrongly on the joint variables is wrong whatever frames are chosen.
    cells = handed_in_values(roles)
    is_gradable = np.array(
        [[bool(role.row and role.row.entries[c].readable) for c in range(4)] for role in roles]
    )
    angle = np.tile(IS_ANGLE, len(roles))
    counts, linear = joint_counts(cells.reshape(-1, SAMPLES), joints, samples, angle)
    counts = counts.reshape(len(roles), len(COLUMNS), len(joints))
    linear = linear.reshape(is_gradable.shape)
    expected = np.zeros_like(counts)
    joint_signs = np.zeros(len(roles), dtype=np.int_)
    for (i, column), joint in joint_cells(roles).items():
        place = i, column, joints.index(joint)
        joint_signs[i] = counts[place] if abs(counts[place]) == 1 else 0
        expected[place] = joint_signs[i] or 1
    variables = np.array([samples.values[joint.variable] for joint in joints])
    constants = (cells - counts @ variables)[..., :HALF]
    written = np.where((is_gradable & linear)[..., None], constants, np.nan)
    wrong_regardless = is_gradable & ~(linear & (counts == expected).all(axis=-1))
    rows = zip(
        regrouped(written, convention),
        regrouped(is_gradable, convention),
        regrouped(wrong_regardless, convention),
        ~regrouped(np.ones_like(is_gradable), convention),
        regrouped(slack_of_cells(roles, samples), convention),
        [None, *(role.joint and variable_column(role.joint) for role in roles)],
        [0, *joint_signs.tolist()],
        strict=True,
    )
    return [RowConstants(*row) for row in rows]


def without_variables(
    tables: Numbers, roles: tuple[Role, ...], samples: Samples
) -> tuple[Numbers, NDArray[np.int_]]:
    """Return the constants of tables, and the signs of their joint variables.

    A constant is NaN if its cell depends wrongly on the joint variables.
    """
    # Tables are ``(T, rows, 4, samples)``, constants ``(T, rows, 4, samples / 2)``, signs ``(T,
    # rows)``.
    tables = tables.copy()
    signs = np.zeros(tables.shape[:2], dtype=np.int_)
    for (i, column), joint in joint_cells(roles).items():
        variable = samples.values[joint.variable]
        for sign in (1, -1):
            rest = tables[:, i, column] - sign * variable
            change = np.abs(difference(*halves(rest), IS_ANGLE[column])).max(axis=-1)
            signs[change < SAME_MOTION, i] = sign
        tables[:, i, column] -= signs[:, i, None] * variable
        tables[signs[:, i] == 0, i, column] = np.nan
    first, second = halves(tables)
    moves = np.abs(difference(first, second, IS_ANGLE[:, None])).max(axis=-1) >= SAME_MOTION
    return np.where(moves[..., None], np.nan, first), signs
