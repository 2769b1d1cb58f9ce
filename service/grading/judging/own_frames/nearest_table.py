"""The valid table nearest to a handed-in one, where it is known which row is for which joint."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from service.grading.judging.own_frames.base_frame import possible_bases
from service.grading.judging.own_frames.constants import (
    TableConstants,
    row_constants,
    table_constants,
)
from service.grading.judging.own_frames.few_cells import NearestTable, nearest_by_few_cells
from service.grading.judging.own_frames.reference import (
    Mechanism,
    as_table,
    mechanism_at,
    reference_frames,
)
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role, variable_column
from service.grading.judging.own_frames.validity import targets_of
from service.grading.judging.own_frames.wrong_convention_or_unit import nearest_as_intended
from service.grading.part import Grading
from service.grading.samples import Samples
from service.kinematics.chain import THETA, D, Table
from service.kinematics.chain_match import ChainMatch, match_as_written
from service.kinematics.dh import Convention, standard_link
from service.kinematics.frame_choice import NO_SUCH_CELL, WRONG_CELL
from service.kinematics.frame_choice import nearest_table as search_nearest_table
from service.kinematics.tolerances import PARALLEL
from service.kinematics.transforms import Matrices, inverse


def nearest_for_roles(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """The valid table nearest to the one handed in, its rows taken for ``roles``."""
    if freedom == FrameFreedom() and all(role.row is not None for role in roles):
        nearest = nearest_by_few_cells(roles, convention, grading)
        nearest = nearest or nearest_as_intended(roles, convention, freedom, grading)
        if nearest is not None:
            return nearest
    return _search(roles, convention, freedom, grading)


def _search(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """The nearest valid table, found row by row: with any freedom and any number of wrong cells."""
    joints = grading.exercise.robot.joints
    mechanism = mechanism_at(grading.exercise, grading.samples)
    constants = table_constants(roles, joints, mechanism.samples)
    targets = targets_of(roles, convention, mechanism, freedom)
    rows = row_constants(roles, constants, convention)
    directions_given, base_given = not freedom.directions, not freedom.base
    scale = mechanism.length_scale
    bases = [None] if base_given else possible_bases(roles, joints, convention, mechanism, freedom)
    match = None
    for base in bases:
        match = match or match_as_written(
            rows, targets, scale, directions_given=directions_given, start=base
        )
    if match is None:
        match = search_nearest_table(
            rows, targets, scale, base_given=base_given, directions_given=directions_given
        )
        if not base_given and match.cost < WRONG_CELL and not constants.rounded.any():
            # It is not valid from any possible base: then it cannot be right.
            match = replace(match, cost=match.cost + NO_SUCH_CELL)
    return NearestTable(
        roles=roles,
        expected=_expected(roles, match, constants, convention, mechanism.samples, freedom),
        frames=_joint_frames(roles, match, convention, mechanism),
        cost=match.cost,
    )


def _expected(
    roles: tuple[Role, ...],
    match: ChainMatch,
    constants: TableConstants,
    convention: Convention,
    samples: Samples,
    freedom: FrameFreedom,
) -> Table:
    """What each cell should be, joint variables included: ``(rows, 4, SAMPLES)``."""
    table = np.tile(as_table(match.rows, convention), 2)
    for i, role in enumerate(roles):
        if role.joint is not None:
            sign = match.joint_signs[i]
            if freedom.directions and constants.joint_signs[i]:
                sign = int(constants.joint_signs[i])
            table[i, variable_column(role.joint)] += sign * samples.values[role.joint.variable]
    return table


def _joint_frames(
    roles: tuple[Role, ...],
    match: ChainMatch,
    convention: Convention,
    mechanism: Mechanism,
) -> Matrices:
    """The student's frames on the joint axes as seen from the reference's.

    The relative pose of a joint is that of the frame which its Z starts from. That is the frame on
    its axis in the standard convention; in the modified one, that is the frame which Z leads to.
    """
    places = [i for i, role in enumerate(roles) if role.joint is not None]
    relative_poses = np.array([match.relative_poses[i] for i in places])
    if convention is Convention.STANDARD:
        return relative_poses
    rows = np.array([match.rows[i + 1] for i in places])
    zero = np.zeros_like(rows[:, D])
    offsets = standard_link(zero, zero, rows[:, D], rows[:, THETA])
    return np.asarray(inverse(mechanism.offsets) @ relative_poses @ offsets)


def parallel_neighbours(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> NDArray[np.bool_]:
    """Which rows' axes are parallel to the axis before or after, so that offsets along them add up.

    ``(rows,)``.
    """
    reference = reference_frames(grading.exercise, convention, grading.samples)
    axes = reference[:, :2, :3, 2]
    parallel = np.abs(np.cross(axes[:-1], axes[1:])).max(axis=(1, 2)) < PARALLEL
    # The tool's axis counts only if there is a row whose d lies along it.
    parallel[-1] &= roles[-1].joint is None
    of_joints = iter((parallel | np.append(False, parallel[:-1])).tolist())
    return np.array([role.joint is not None and next(of_joints) for role in roles])
