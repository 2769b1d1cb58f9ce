"""Which row of a handed-in table is for which joint."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from service.catalogue import Joint
from service.grading.joint_motion import changes, joint_counts
from service.grading.reading.table import IS_ANGLE, HandedInRow, aligned, values_of
from service.grading.samples import SAMPLES, Samples
from service.kinematics.chain import COLUMNS, THETA, D
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class Role:
    """A row and the joint it is for; a row without joint is fixed, a joint without row missing."""

    row: HandedInRow | None
    joint: Joint | None


def variable_column(joint: Joint) -> int:
    """The column that the joint's variable stands in."""
    return D if joint.prismatic else THETA


def joint_cells(roles: Sequence[Role]) -> dict[tuple[int, int], Joint]:
    """The cells that hold a joint's variable, each a row and a column, in the order of the rows."""
    return {
        (i, variable_column(role.joint)): role.joint for i, role in enumerate(roles) if role.joint
    }


def motion_of(roles: Sequence[Role], samples: Samples) -> Numbers:
    """How each cell of a right table changes with the joints: ``(rows, 4, samples / 2)``."""
    motion = np.zeros((len(roles), len(COLUMNS), samples.count // 2))
    for cell, joint in joint_cells(roles).items():
        motion[cell] = changes(samples.values[joint.variable])
    return motion


def roles_of(
    rows: Sequence[HandedInRow],
    joints: tuple[Joint, ...],
    samples: Samples,
    wanted: int,
    *,
    in_order: bool | None = None,
) -> tuple[Role, ...]:
    """Which row is for which joint; ``wanted`` is how many rows the reference's table has.

    As many rows as joints are taken in order, unless ``in_order`` says otherwise. Else the joint
    variables tell: the pairing in order that meets most of them, rows left over being fixed ones.
    Where they do not tell, and there are as many rows as wanted, these are the joints' rows and
    then the fixed ones.
    """
    one_by_one = tuple(Role(row, joint) for row, joint in zip_longest(rows, joints))
    if len(rows) == len(joints) if in_order is None else in_order:
        return one_by_one
    values = values_of(rows).reshape(-1, SAMPLES)
    counts, _ = joint_counts(values, joints, samples, np.tile(IS_ANGLE, len(rows)))
    holds = np.abs(counts.reshape(len(rows), len(COLUMNS), len(joints))) > 0
    scores: Numbers = np.asarray(0.25 + holds.any(axis=1))
    for j, joint in enumerate(joints):
        scores[:, j] += holds[:, variable_column(joint), j]
    pairs = aligned(scores)
    told = sum(scores[i, j] > 1 for i, j in pairs if i is not None and j is not None)
    if told < len(joints) and len(rows) == wanted:
        return one_by_one
    return tuple(
        Role(None if i is None else rows[i], None if j is None else joints[j]) for i, j in pairs
    )
