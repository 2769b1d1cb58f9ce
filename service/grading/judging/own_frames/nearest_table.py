"""The valid table nearest to a handed-in one, where it is known which row is for which joint."""

from dataclasses import replace
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from service.grading.joint_motion import halves
from service.grading.judging.own_frames.constants import row_constants, without_variables
from service.grading.judging.own_frames.few_cells import (
    NearestTable,
    frames_from_reference,
    nearest_by_few_cells,
)
from service.grading.judging.own_frames.reference import (
    Mechanism,
    as_table,
    mechanism_at,
    reference_frames,
    regrouped,
    tool_pose,
)
from service.grading.judging.own_frames.row_roles import (
    FrameFreedom,
    Role,
    handed_in_values,
    joint_cells,
)
from service.grading.judging.own_frames.validity import targets_of, valid_tables
from service.grading.judging.own_frames.written_table import (
    MISCONCEPTIONS,
    WrittenTable,
    written_table,
)
from service.grading.misconception import hypotheses_of
from service.grading.part import Grading
from service.grading.samples import HALF
from service.grading.tolerances import INTENDED_POSE, UNCHANGED_CELL
from service.kinematics.axis_alignment import align_axes
from service.kinematics.chain import Table, axis_frames, pose, z_links
from service.kinematics.chain_match import ChainMatch, match_as_written
from service.kinematics.dh import Convention
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
        nearest = nearest or _as_intended(roles, convention, freedom, grading)
        if nearest is not None:
            return nearest
    return _search(roles, convention, freedom, grading)


def _as_intended(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable | None:
    """The table without a mistake of convention or of the unit of all angles, if that is valid.

    Such a slip makes most cells wrong at once. The intended table is known all the same, and so is
    the right value of each cell: nothing has to be guessed from the cells that agree with some
    valid table.
    """
    values = handed_in_values(roles)
    if not np.isfinite(values).all():
        return None
    exercise, samples = grading.exercise, grading.samples
    handed_in = written_table(values, convention, None, exercise.robot.joints, samples)
    for repaired in hypotheses_of(handed_in, MISCONCEPTIONS):
        table = repaired.answer
        [valid] = valid_tables(
            table.values[None], roles, table.convention, freedom, exercise, samples, INTENDED_POSE
        )
        intended = in_convention(table, convention) if valid else None
        if intended is not None:
            frames = frames_from_reference(intended, roles, convention, grading)
            changed = np.abs(intended - values).max(axis=-1) > UNCHANGED_CELL
            cost = WRONG_CELL * max(1, int(np.count_nonzero(changed)))
            return NearestTable(roles, intended, frames, cost)
    return None


def in_convention(table: WrittenTable, convention: Convention) -> Table | None:
    """The same chain in a convention, ``(rows, 4, samples)``; None where that takes other rows."""
    links = regrouped(table.values, table.convention)
    left_out = links[0] if convention is Convention.STANDARD else links[-1, :2]
    return None if left_out.any() else as_table(links, convention)


def _search(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """The nearest valid table, found row by row: with any freedom and any number of wrong cells."""
    exercise, samples = grading.exercise, grading.samples
    scale, directions_given = exercise.length_scale, not freedom.directions
    mechanism = mechanism_at(exercise, samples)
    targets = targets_of(roles, convention, mechanism, freedom)
    rows = row_constants(roles, exercise.robot.joints, convention, samples)
    bases = _possible_bases(roles, convention, freedom, grading) if freedom.base else [None]
    match = None
    for base in bases:
        match = match or match_as_written(
            rows, targets, scale, directions_given=directions_given, start=base
        )
    if match is None:
        match = search_nearest_table(
            rows, targets, scale, base_given=not freedom.base, directions_given=directions_given
        )
        rounded = any(row.tolerance.any() for row in rows)
        if freedom.base and match.cost < WRONG_CELL and not rounded:
            # It is not valid from any possible base: then it cannot be right.
            match = replace(match, cost=match.cost + NO_SUCH_CELL)
    # What each cell should be: the constants and the joint variables.
    expected = np.tile(as_table(match.rows, convention), 2)
    for (i, column), joint in joint_cells(roles).items():
        sign = (freedom.directions and rows[i + 1].joint_sign) or match.joint_signs[i]
        expected[i, column] += sign * samples.values[joint.variable]
    frames = _joint_frames(roles, match, convention, mechanism)
    return NearestTable(roles, expected, frames, match.cost)


def _possible_bases(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> list[Matrices]:
    """Where a free frame 0 may lie in the reference's frame 0, ``(HALF, 4, 4)`` each.

    A given tool leaves one possibility. Otherwise the student's joint axes must lie on the
    reference's, each in the direction that the sign of its variable says, or in either direction
    where the directions are free.
    """
    table = handed_in_values(roles)
    if np.isnan(table).any():
        return []
    exercise, samples = grading.exercise, grading.samples
    if not freedom.tool:
        return [(tool_pose(exercise, samples) @ inverse(pose(table, convention)))[:HALF]]
    sliding = np.array([joint.prismatic for joint in exercise.robot.joints])
    rows = [i for i, _ in joint_cells(roles)]
    constants, signs = (x[0] for x in without_variables(table[None], roles, samples))
    if not freedom.directions:
        student_axes = axis_frames(halves(table)[0], convention, Convention.STANDARD)[rows]
        target = reference_frames(exercise, Convention.STANDARD, samples)[:-1, :HALF]
        return [align_axes(_directed(student_axes, signs[rows]), target, sliding)]
    # A variable may have either sign, so the axes are compared where all variables are 0. Only the
    # first axis and the next that is not parallel to it decide how the base is turned.
    student_axes = axis_frames(constants, convention, Convention.STANDARD)[rows]
    target = np.array(list(accumulate(mechanism_at(exercise, samples).joints, np.matmul)))
    directions = [
        np.array([first, *[others] * (len(rows) - 1)]) for first in (1, -1) for others in (1, -1)
    ]
    return [align_axes(_directed(student_axes, signs), target, sliding) for signs in directions]


def _directed(frames: Matrices, signs: NDArray[np.int_]) -> Matrices:
    """The frames with z reversed where the sign is −1."""
    directed = frames.copy()
    directed[signs < 0, :, :3, :3] *= np.array([1.0, -1.0, -1.0])
    return directed


def _joint_frames(
    roles: tuple[Role, ...], match: ChainMatch, convention: Convention, mechanism: Mechanism
) -> Matrices:
    """The student's frames on the joint axes as seen from the reference's.

    The relative pose of a joint is that of the frame which its Z starts from. That is the frame on
    its axis in the standard convention; in the modified one, that is the frame which Z leads to.
    """
    places = [i for i, _ in joint_cells(roles)]
    relative_poses = match.relative_poses[places]
    if convention is Convention.STANDARD:
        return relative_poses
    offsets = z_links(match.rows[1:][places])
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
