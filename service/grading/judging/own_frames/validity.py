"""Test which of many tables describe the robot."""

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise
from service.grading.judging.own_frames.constants import without_variables
from service.grading.judging.own_frames.reference import (
    Mechanism,
    mechanism_at,
    reference_frames,
    regrouped,
)
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role, variables_of
from service.grading.numerics.joint_motion import changes, moves_with
from service.grading.numerics.samples import Samples
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import pose
from service.kinematics.dh import Convention
from service.kinematics.frames.candidate_rows import TargetKind
from service.kinematics.frames.chain_match import Target, match_tables
from service.kinematics.transforms import Numbers


def valid_tables(
    tables: Numbers,
    roles: tuple[Role, ...],
    convention: Convention,
    freedom: FrameFreedom,
    exercise: Exercise,
    samples: Samples,
    tolerance: float,
) -> NDArray[np.bool_]:
    """Return a mask ``(T,)`` of the T tables that describe the robot in some allowed frames.

    ``tables`` is ``(T, rows, 4, samples)``.
    """
    # All tables have the same ``roles``. The base counts as given, even if it is free.
    if not (freedom.tool or freedom.directions):
        return _valid_by_pose(tables, roles, convention, exercise, samples, tolerance)
    constants, signs = without_variables(tables, roles, samples)
    if freedom.directions:
        signs = np.zeros_like(signs)
    targets = targets_of(roles, convention, mechanism_at(exercise, samples), freedom)
    rows = np.moveaxis(regrouped(np.moveaxis(constants, 0, -1), convention), -1, 0)
    signs = np.pad(signs, ((0, 0), (1, 0)))
    return match_tables(rows, signs, targets, exercise.length_scale, tolerance)[0]


def _valid_by_pose(
    tables: Numbers,
    roles: tuple[Role, ...],
    convention: Convention,
    exercise: Exercise,
    samples: Samples,
    tolerance: float,
) -> NDArray[np.bool_]:
    # Base, tool and directions are given. The tolerance is relative to the reach of the arm.
    moves = moves_with(tables, changes(variables_of(roles, samples)), IS_ANGLE[:, None])
    valid = np.asarray(moves.all(axis=(1, 2)))
    expected = reference_frames(exercise, convention, samples)[-1]
    reach = max(exercise.length_scale, float(np.abs(expected[:, :3, 3]).max()))
    # Most tables fail at the first sample.
    for chosen in (slice(0, 1), slice(None)):
        left = np.flatnonzero(valid)
        if left.size:
            reached = pose(np.moveaxis(tables[left][..., chosen], 0, 2), convention)
            error = np.abs(reached - expected[chosen])
            error[..., :3, 3] /= reach
            valid[left] = error.max(axis=(1, 2, 3)) <= tolerance
    return valid


def targets_of(
    roles: tuple[Role, ...], convention: Convention, mechanism: Mechanism, freedom: FrameFreedom
) -> list[Target]:
    """Return what each row must lead to: a joint axis, the frame of a fixed row, or the tool."""
    targets: list[Target] = []
    links, fixed = iter(mechanism.joints), iter(mechanism.fixed)
    last_joint = max((i for i, role in enumerate(roles) if role.joint), default=-1)
    for i, role in enumerate(roles):
        kind, frame = TargetKind.FIXED, None
        if role.joint is not None:
            kind = TargetKind.PRISMATIC if role.joint.prismatic else TargetKind.REVOLUTE
            frame = next(links)
        elif i == len(roles) - 1 and convention is Convention.MODIFIED:
            # Only the Z of the last row leads from there to the tool, so z must lie on the tool's
            # z.
            frame = mechanism.tool
        elif i > last_joint:
            frame = next(fixed, None)
        targets.append(Target(kind, frame))
    tool = TargetKind.OPEN if freedom.tool else TargetKind.TOOL
    return [*targets, Target(tool, mechanism.tool)]
