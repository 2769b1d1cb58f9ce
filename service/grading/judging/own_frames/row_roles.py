"""Pair the rows of a submitted table with joints.

Each pair of a row and its joint is called a role.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from service.catalogue import Joint
from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.numerics.joint_motion import joint_counts
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.reading.tables.table import IS_ANGLE, StudentRow, values_of
from service.kinematics.chain import COLUMNS, THETA, D, Table
from service.kinematics.factors import CellIndex
from service.kinematics.transforms import Numbers

_NOTHING = np.full((len(COLUMNS), SAMPLES), np.nan)


@dataclass(frozen=True, slots=True)
class FrameFreedom:
    """What an exercise lets the student choose: base frame, tool frame, axis directions."""

    base: bool = False
    tool: bool = False
    directions: bool = False


def freedom_of(part: DhTableSpec) -> FrameFreedom:
    """Return which of base frame, tool frame and axis directions the student may choose."""
    return FrameFreedom(part.base == "free", part.tool == "free", part.directions == "free")


@dataclass(frozen=True, slots=True)
class Role:
    """A row of a submitted table, and the joint that it belongs to.

    ``joint`` is None for a row without a joint. ``row`` is None if the student left the row out.
    """

    row: StudentRow | None
    joint: Joint | None


def variable_column(joint: Joint) -> int:
    """Return the column of the joint's variable."""
    return D if joint.prismatic else THETA


def joint_cells(roles: Sequence[Role]) -> dict[CellIndex, Joint]:
    """Return the cells that should contain joint variables, with their joints."""
    return {
        (i, variable_column(role.joint)): role.joint for i, role in enumerate(roles) if role.joint
    }


def handed_in_values(roles: Sequence[Role]) -> Table:
    """Return the values of the rows, ``(rows, 4, SAMPLES)``, NaN for a missing row."""
    return np.array([role.row.values if role.row else _NOTHING for role in roles])


def variables_of(roles: Sequence[Role], samples: Samples) -> Table:
    """Return the joint variable that belongs in each cell, or 0: ``(rows, 4, samples)``."""
    return joint_variables([role.joint for role in roles], samples)


def joint_variables(joints: Sequence[Joint | None], samples: Samples) -> Table:
    """Return the joint variable that belongs in each cell, or 0. Do not modify the array.

    ``joints`` has the joint of each row, None for a row without a joint.
    """

    def compute() -> Table:
        variables = np.zeros((len(joints), len(COLUMNS), samples.count))
        for row, joint in zip(variables, joints, strict=True):
            if joint is not None:
                row[variable_column(joint)] = samples.values[joint.variable]
        return variables

    names = tuple(joint and joint.variable for joint in joints)
    return samples.cached(("variables", names), compute)


def roles_of(
    rows: Sequence[StudentRow],
    joints: tuple[Joint, ...],
    samples: Samples,
    expected_rows: int,
    *,
    in_order: bool | None = None,
) -> tuple[Role, ...]:
    """Return each row with its joint.

    ``expected_rows`` is the number of rows of the reference table.
    """
    # If there are as many rows as joints, they are paired in order, unless ``in_order`` is false.
    # Otherwise the pairing in order is taken in which most rows have their joint's variable; the
    # remaining rows are fixed. If the variable of some joint is missing, and the number of rows is
    # as expected, the joints' rows come first.
    one_by_one = tuple(Role(row, joint) for row, joint in zip_longest(rows, joints))
    if len(rows) == len(joints) if in_order is None else in_order:
        return one_by_one
    values = values_of(rows).reshape(-1, SAMPLES)
    counts, _ = joint_counts(values, joints, samples, np.tile(IS_ANGLE, len(rows)))
    holds = np.abs(counts.reshape(len(rows), len(COLUMNS), len(joints))) > 0
    scores: Numbers = np.asarray(0.25 + holds.any(axis=1))
    for j, joint in enumerate(joints):
        scores[:, j] += holds[:, variable_column(joint), j]
    pairs = pair_in_order(scores)
    recognised = sum(scores[i, j] > 1 for i, j in pairs if i is not None and j is not None)
    if recognised < len(joints) and len(rows) == expected_rows:
        return one_by_one
    return tuple(
        Role(None if i is None else rows[i], None if j is None else joints[j]) for i, j in pairs
    )


def pair_in_order(scores: Numbers) -> list[tuple[int | None, int | None]]:
    """Pair submitted rows with expected rows, in order, so that the sum of scores is the largest.

    ``scores`` is ``(submitted, expected)``. (None, j) is a missing row, (i, None) an extra row.
    """
    # For equal sums, the last rows have no partner. The method is the weighted recurrence of the
    # longest common subsequence.
    m, n = scores.shape
    best = np.zeros((m + 1, n + 1))
    for i in reversed(range(m)):
        for j in reversed(range(n)):
            best[i, j] = max(scores[i, j] + best[i + 1, j + 1], best[i + 1, j], best[i, j + 1])
    pairs: list[tuple[int | None, int | None]] = []
    i = j = 0
    while i < m or j < n:
        if i < m and j < n and best[i, j] == scores[i, j] + best[i + 1, j + 1]:
            pairs.append((i, j))
            i, j = i + 1, j + 1
        elif j < n and best[i, j] == best[i, j + 1]:
            pairs.append((None, j))
            j += 1
        else:
            pairs.append((i, None))
            i += 1
    return pairs
