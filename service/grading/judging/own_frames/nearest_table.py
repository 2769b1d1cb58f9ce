"""A handed-in table under frames of the student's own choice.

Turns the table's rows into what ``kinematics.frame_choice`` searches with, and its answer back into
what each cell should have been, in the student's own frames.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from service.grading.judging.own_frames.base_frame import own_bases
from service.grading.judging.own_frames.constants import Written, written_constants, written_rows
from service.grading.judging.own_frames.few_cells import FrameReading, nearest_by_few_cells
from service.grading.judging.own_frames.frame_freedom import Freedom
from service.grading.judging.own_frames.reference import (
    Mechanism,
    as_table,
    mechanism_at,
    reference_frames,
)
from service.grading.judging.own_frames.row_roles import Role, variable_column
from service.grading.judging.own_frames.validity import stops_of
from service.grading.judging.own_frames.wrong_convention_or_unit import read_as_meant
from service.grading.part import Grading
from service.grading.samples import Samples
from service.kinematics.candidate_rows import PARALLEL
from service.kinematics.chain import THETA, D, Table
from service.kinematics.chain_match import Nearest, valid_as_it_stands
from service.kinematics.dh import Convention, standard_link
from service.kinematics.frame_choice import NO_SUCH_CELL, WRONG_CELL, nearest_table
from service.kinematics.transforms import Matrices, inverse


def read_in_own_frames(
    roles: tuple[Role, ...], convention: Convention, freedom: Freedom, grading: Grading
) -> FrameReading:
    """The valid table nearest to the one handed in."""
    if freedom == Freedom() and all(role.row is not None for role in roles):
        reading = nearest_by_few_cells(roles, convention, grading)
        reading = reading or read_as_meant(roles, convention, freedom, grading)
        if reading is not None:
            return reading
    return _searched(roles, convention, freedom, grading)


def _searched(
    roles: tuple[Role, ...], convention: Convention, freedom: Freedom, grading: Grading
) -> FrameReading:
    """The nearest valid table, row by row: for whatever freedom, and however much is wrong."""
    joints = grading.exercise.robot.joints
    mechanism = mechanism_at(grading.exercise, grading.samples)
    written = written_constants(roles, joints, mechanism.samples)
    stops = stops_of(roles, convention, mechanism, freedom)
    rows = written_rows(roles, written, convention)
    directions_given, base_given = not freedom.directions, not freedom.base
    scale = mechanism.length_scale
    starts = [None] if base_given else own_bases(roles, joints, convention, mechanism, freedom)
    nearest = None
    for start in starts:
        nearest = nearest or valid_as_it_stands(
            rows, stops, scale, directions_given=directions_given, start=start
        )
    if nearest is None:
        nearest = nearest_table(
            rows, stops, scale, base_given=base_given, directions_given=directions_given
        )
        if not base_given and nearest.cost < WRONG_CELL and not written.rounded.any():
            # Not valid from any base there is: then it cannot be right.
            nearest = replace(nearest, cost=nearest.cost + NO_SUCH_CELL)
    return FrameReading(
        roles=roles,
        expected=_expected(roles, nearest, written, convention, mechanism.samples, freedom),
        frames=_joint_frames(roles, nearest, convention, mechanism),
        cost=nearest.cost,
    )


def parallel_neighbours(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> NDArray[np.bool_]:
    """Which rows' axes are parallel to the axis before or behind: ``(rows,)``.

    Offsets along such axes add up.
    """
    reference = reference_frames(grading.exercise, convention, grading.samples)
    axes = reference[:, :2, :3, 2]
    apart = np.abs(np.cross(axes[:-1], axes[1:])).max(axis=(1, 2))
    beside = apart < PARALLEL
    # The tool's axis counts only if there is a row whose d lies along it.
    beside[-1] &= roles[-1].joint is None
    of_joints = iter((beside | np.append(False, beside[:-1])).tolist())
    return np.array([role.joint is not None and next(of_joints) for role in roles])


def _joint_frames(
    roles: tuple[Role, ...],
    nearest: Nearest,
    convention: Convention,
    mechanism: Mechanism,
) -> Matrices:
    """Where the student's frames on the joint axes lie in the reference's.

    A row's place is where its joint's Z starts from. In the standard convention that is the frame;
    in the modified one the frame is where Z leads to.
    """
    places = [i for i, role in enumerate(roles) if role.joint is not None]
    apart = np.array([nearest.poses[i] for i in places])
    if convention is Convention.STANDARD:
        return apart
    own = np.array([nearest.rows[i + 1] for i in places])
    zero = np.zeros_like(own[:, D])
    offsets = standard_link(zero, zero, own[:, D], own[:, THETA])
    return np.asarray(inverse(mechanism.offsets) @ apart @ offsets)


def _expected(
    roles: tuple[Role, ...],
    nearest: Nearest,
    written: Written,
    convention: Convention,
    samples: Samples,
    freedom: Freedom,
) -> Table:
    """What each cell should be, joint variables and all: ``(rows, 4, SAMPLES)``."""
    table = np.tile(as_table(nearest.rows, convention), 2)
    for i, role in enumerate(roles):
        if role.joint is not None:
            sense = nearest.senses[i]
            if freedom.directions and written.senses[i]:
                sense = int(written.senses[i])
            table[i, variable_column(role.joint)] += sense * samples.values[role.joint.variable]
    return table
