"""Find the valid table (one that describes the robot) nearest to a submitted table."""

from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from service.grading.judging.own_frames.base_frame import possible_bases
from service.grading.judging.own_frames.constants import row_constants
from service.grading.judging.own_frames.nearest.few_cells import (
    NearestTable,
    frames_from_reference,
    nearest_by_few_cells,
)
from service.grading.judging.own_frames.nearest.one_cell import one_cell_match
from service.grading.judging.own_frames.nearest.spoiled_row import with_spoiled_row
from service.grading.judging.own_frames.reference import (
    Mechanism,
    as_table,
    frames_on_axes,
    mechanism_at,
    reference_frames,
    regrouped,
)
from service.grading.judging.own_frames.row_roles import (
    FrameFreedom,
    Role,
    handed_in_values,
    joint_cells,
)
from service.grading.judging.own_frames.validity import targets_of, valid_tables
from service.grading.judging.own_frames.written_table import (
    Rereadable,
    WrittenTable,
    written_table,
)
from service.grading.misconception import hypotheses_of
from service.grading.numerics.tolerances import INTENDED_POSE, UNCHANGED_CELL
from service.grading.part import Grading
from service.kinematics.chain import Table
from service.kinematics.dh import Convention
from service.kinematics.frames.chain_match import (
    ChainMatch,
    RowConstants,
    Target,
    match_as_written,
    match_tables,
)
from service.kinematics.frames.frame_choice import WRONG_CELL
from service.kinematics.frames.frame_choice import nearest_table as search_nearest_table
from service.kinematics.frames.reversed_chain import (
    reversed_cells,
    reversed_rows,
    reversed_targets,
)
from service.kinematics.tolerances import PARALLEL
from service.kinematics.transforms import cross


def nearest_for_roles(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """Return the valid table nearest to rows whose joints are known."""
    if freedom == FrameFreedom() and all(role.row is not None for role in roles):
        nearest = nearest_by_few_cells(roles, convention, grading)
        nearest = nearest or _as_intended(roles, convention, freedom, grading)
        if nearest is not None and 2 * WRONG_CELL < nearest.lost < np.inf:
            # Frames in which cells of several rows are wrong may lose less than a whole row.
            searched = _link_by_link(roles, convention, freedom, grading)
            nearest = replace(nearest, lost=min(nearest.lost, searched.lost))
        if nearest is not None:
            return nearest
    return _link_by_link(roles, convention, freedom, grading)


def _as_intended(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable | None:
    values = handed_in_values(roles)
    if not np.isfinite(values).all():
        return None
    exercise, samples = grading.exercise, grading.samples
    handed_in = written_table(values, convention, None, exercise.robot.joints, samples)
    for repaired in hypotheses_of(handed_in, Rereadable):
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
    """Convert a table to a convention; return None if the table would get more or fewer rows."""
    links = regrouped(table.values, table.convention)
    left_out = links[0] if convention is Convention.STANDARD else links[-1, :2]
    return None if left_out.any() else as_table(links, convention)


def _link_by_link(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    # Try the table as written, then tables that differ in one cell, then a search.
    exercise, samples = grading.exercise, grading.samples
    scale = exercise.length_scale
    mechanism = mechanism_at(exercise, samples)
    targets = targets_of(roles, convention, mechanism, freedom)
    rows = row_constants(roles, exercise.robot.joints, convention, samples)
    match = _as_written(rows, targets, roles, mechanism, freedom, scale)
    if match is None and freedom != FrameFreedom() and all(role.row for role in roles):
        match = one_cell_match(rows, targets, roles, convention, freedom, grading)
    # The cell may be the only wrong one in these frames, and its row may lose less in other frames.
    if match is None or match.cost > WRONG_CELL:
        searched = _searched(rows, targets, roles, convention, mechanism, freedom, scale)
        lost = searched.lost if match is None else min(match.lost, searched.lost)
        match = replace(match or searched, lost=lost)
    # Each cell should be its constant plus its joint variable.
    expected = np.tile(as_table(match.rows, convention), 2)
    for (i, column), joint in joint_cells(roles).items():
        sign = (freedom.directions and rows[i + 1].joint_sign) or match.joint_signs[i]
        expected[i, column] += sign * samples.values[joint.variable]
    frames = frames_on_axes(match.relative_poses, match.rows, roles, convention, mechanism)
    lost = match.lost
    if lost > WRONG_CELL and freedom != FrameFreedom():
        spoiled = with_spoiled_row(roles, expected, scale)
        if spoiled is not None:
            rows = row_constants(spoiled, exercise.robot.joints, convention, samples)
            searched = _searched(rows, targets, roles, convention, mechanism, freedom, scale)
            lost = min(lost, searched.lost)
    return NearestTable(roles, expected, frames, match.cost, lost)


def _as_written(
    rows: list[RowConstants],
    targets: list[Target],
    roles: tuple[Role, ...],
    mechanism: Mechanism,
    freedom: FrameFreedom,
    scale: float,
) -> ChainMatch | None:
    written = np.array([row.written for row in rows])
    signs = np.array([row.joint_sign for row in rows])
    for base in possible_bases(written, signs, roles, mechanism, freedom):
        match = match_as_written(
            rows, targets, scale, directions_given=not freedom.directions, start=base
        )
        if match is not None:
            return match
    return None


def _searched(
    rows: list[RowConstants],
    targets: list[Target],
    roles: tuple[Role, ...],
    convention: Convention,
    mechanism: Mechanism,
    freedom: FrameFreedom,
    scale: float,
) -> ChainMatch:
    search = partial(
        search_nearest_table, length_scale=scale, directions_given=not freedom.directions
    )
    z_ends_rows = convention is Convention.MODIFIED
    # Seen from the tool, the two halves of a row are in the opposite order.
    search = partial(search, z_ends_rows=z_ends_rows != (freedom.base and not freedom.tool))
    if not freedom.base:
        return search(rows, targets)
    if freedom.tool:
        match = search(rows, targets, base_given=False)
        if match.cost >= WRONG_CELL:
            return match
    else:
        seen_from_tool = reversed_targets(targets, mechanism.offsets)
        match = search(reversed_rows(rows), seen_from_tool)
        match = replace(match, rows=-reversed_cells(match.rows))
    signs = np.array([row.joint_sign for row in rows])
    bases = possible_bases(match.rows, signs, roles, mechanism, freedom)
    if freedom.tool:
        return min((search(rows, targets, start=base) for base in bases), key=lambda m: m.cost)
    [base] = bases
    _, poses = match_tables(match.rows[None], 0 * signs[None], targets, scale, start=base)
    return replace(match, relative_poses=poses[:, 0])


def parallel_neighbours(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> NDArray[np.bool_]:
    """Return a mask ``(rows,)`` of the rows whose axis is parallel to a neighbouring axis."""
    # Offsets along parallel axes add up.
    reference = reference_frames(grading.exercise, convention, grading.samples)
    axes = reference[:, :2, :3, 2]
    parallel = np.abs(cross(axes[:-1], axes[1:])).max(axis=(1, 2)) < PARALLEL
    # The tool's axis counts only if the d of some row lies along it.
    parallel[-1] &= roles[-1].joint is None
    of_joints = iter((parallel | np.append(False, parallel[:-1])).tolist())
    return np.array([role.joint is not None and next(of_joints) for role in roles])
