"""What a handed-in table says, taken apart into constants and joint variables."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.comparison import ROUNDED, difference
from service.grading.joint_motion import TOLERANCE, halves, joint_counts
from service.grading.judging.own_frames.reference import regrouped
from service.grading.judging.own_frames.row_roles import Role, variable_column
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import HALF, SAMPLES, Samples
from service.kinematics.chain import COLUMNS
from service.kinematics.chain_match import WrittenRow
from service.kinematics.dh import Convention
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class Written:
    """The constants of all rows ``(rows, 4, HALF)``, which cells count, which are wrong anyway.

    ``senses`` ``(rows,)`` is the sign that each row's joint variable was written with, 0 for none.
    """

    own: Numbers
    judged: NDArray[np.bool_]
    spoiled: NDArray[np.bool_]
    rounded: NDArray[np.bool_]
    senses: NDArray[np.int_]


def written_constants(
    roles: tuple[Role, ...], joints: tuple[Joint, ...], samples: Samples
) -> Written:
    """The rows taken apart; a cell that moves otherwise than its joint does is spoiled."""
    nothing = np.full((len(COLUMNS), SAMPLES), np.nan)
    cells = np.array([role.row.values if role.row else nothing for role in roles])
    judged = np.array(
        [[bool(role.row and role.row.entries[c].readable) for c in range(4)] for role in roles]
    )
    angle = np.tile(IS_ANGLE, len(roles))
    counts, linear = joint_counts(cells.reshape(-1, SAMPLES), joints, samples, angle)
    counts = counts.reshape(len(roles), len(COLUMNS), len(joints))
    of_form = linear.reshape(judged.shape)
    wanted = np.zeros_like(counts)
    senses = np.zeros(len(roles), dtype=np.int_)
    for i, role in enumerate(roles):
        if role.joint is not None:
            place = i, variable_column(role.joint), joints.index(role.joint)
            senses[i] = counts[place] if abs(counts[place]) == 1 else 0
            wanted[place] = senses[i] or 1
    variables = np.array([samples.values[joint.variable] for joint in joints])
    constants = (cells - counts @ variables)[..., :HALF]
    return Written(
        own=np.where((judged & of_form)[..., None], constants, np.nan),
        judged=judged,
        spoiled=judged & ~(of_form & (counts == wanted).all(axis=-1)),
        rounded=np.array([role.row.rounded if role.row else [False] * 4 for role in roles]),
        senses=senses,
    )


def written_rows(
    roles: tuple[Role, ...], written: Written, convention: Convention
) -> list[WrittenRow]:
    """The rows regrouped as the steps from place to place."""
    absent = regrouped(np.zeros_like(written.judged), convention, fill=True)
    own = regrouped(written.own, convention, 0.0)
    judged = regrouped(written.judged, convention, fill=False)
    spoiled = regrouped(written.spoiled, convention, fill=False)
    rounded = regrouped(written.rounded, convention, fill=False)
    variables = [None, *(role.joint and variable_column(role.joint) for role in roles)]
    senses = [0, *(int(sense) for sense in written.senses)]
    tolerance = np.where(rounded, ROUNDED, 0.0)
    rows = zip(own, judged, spoiled, absent, tolerance, variables, senses, strict=True)
    return [WrittenRow(*row) for row in rows]


def without_motion(
    tables: Numbers, roles: tuple[Role, ...], samples: Samples
) -> tuple[Numbers, NDArray[np.int_]]:
    """Tables ``(T, rows, 4, SAMPLES)`` less their joint variables, and the variables' signs.

    The constants are ``(T, rows, 4, HALF)``, NaN where a cell moves as it must not.
    """
    tables = tables.copy()
    senses = np.zeros(tables.shape[:2], dtype=np.int_)
    for i, role in enumerate(roles):
        if role.joint is None:
            continue
        column = variable_column(role.joint)
        variable = samples.values[role.joint.variable]
        for sense in (1, -1):
            still = tables[:, i, column] - sense * variable
            rests = np.abs(difference(*halves(still), IS_ANGLE[column])).max(axis=-1) < TOLERANCE
            senses[rests, i] = sense
        tables[:, i, column] -= senses[:, i, None] * variable
        tables[senses[:, i] == 0, i, column] = np.nan
    first, second = halves(tables)
    moves = np.abs(difference(first, second, IS_ANGLE[:, None])).max(axis=-1) >= TOLERANCE
    return np.where(moves[..., None], np.nan, first), senses
