"""Which of many tables describe the robot, in whatever frames."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise
from service.grading.joint_motion import moves_with
from service.grading.judging.own_frames.constants import without_motion
from service.grading.judging.own_frames.frame_freedom import Freedom
from service.grading.judging.own_frames.reference import (
    Mechanism,
    mechanism_at,
    reference_frames,
    regrouped,
)
from service.grading.judging.own_frames.row_roles import Role, motion_of
from service.grading.reading.table import IS_ANGLE
from service.grading.samples import Samples
from service.kinematics.candidate_rows import Place
from service.kinematics.chain import pose
from service.kinematics.chain_match import Stop, followed
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers


def valid_tables(
    tables: Numbers,
    roles: tuple[Role, ...],
    convention: Convention,
    freedom: Freedom,
    exercise: Exercise,
    samples: Samples,
    tolerance: float,
) -> NDArray[np.bool_]:
    """Which of many tables describe the mechanism, in whatever frames: ``(T,)``.

    ``tables`` is ``(T, rows, 4, samples)`` at the samples, all with the same rows for the same
    joints. A free base is not looked into here: it counts as given.
    """
    if not (freedom.tool or freedom.directions):
        return _by_pose(tables, roles, convention, exercise, samples, tolerance)
    own, senses = without_motion(tables, roles, samples)
    if freedom.directions:
        senses = np.zeros_like(senses)
    mechanism = mechanism_at(exercise, samples)
    stops = stops_of(roles, convention, mechanism, freedom)
    links = np.moveaxis(regrouped(np.moveaxis(own, 0, -1), convention, 0.0), -1, 0)
    senses = np.pad(senses, ((0, 0), (1, 0)))
    return followed(links, senses, stops, mechanism.length_scale, tolerance)[0]


def _by_pose(
    tables: Numbers,
    roles: tuple[Role, ...],
    convention: Convention,
    exercise: Exercise,
    samples: Samples,
    tolerance: float,
) -> NDArray[np.bool_]:
    """The same where base, tool and directions are given: then the pose tells (see ``nearest``)."""
    moves = moves_with(tables, motion_of(roles, samples), IS_ANGLE[:, None])
    valid = np.asarray(moves.all(axis=(1, 2)))
    wanted = reference_frames(exercise, convention, samples)[-1]
    reach = max(exercise.length_scale, float(np.abs(wanted[:, :3, 3]).max()))
    # Most fail at the first sample already.
    for chosen in (slice(0, 1), slice(None)):
        left = np.flatnonzero(valid)
        if left.size:
            reached = pose(np.moveaxis(tables[left][..., chosen], 0, 2), convention)
            off = np.abs(reached - wanted[chosen])
            off[..., :3, 3] /= reach
            valid[left] = off.max(axis=(1, 2, 3)) <= tolerance
    return valid


def stops_of(
    roles: tuple[Role, ...], convention: Convention, mechanism: Mechanism, freedom: Freedom
) -> list[Stop]:
    """Where each row leads: joint axes, frames of fixed rows, and in the end the tool."""
    stops: list[Stop] = []
    links = iter(mechanism.joints)
    fixed = iter(mechanism.fixed)
    for i, role in enumerate(roles):
        if role.joint is not None:
            kind = Place.PRISMATIC if role.joint.prismatic else Place.REVOLUTE
            stops.append(Stop(kind, next(links)))
        else:
            stops.append(Stop(Place.FIXED, _fixed_frame(i, roles, convention, mechanism, fixed)))
    return [*stops, Stop(Place.OPEN if freedom.tool else Place.TOOL, mechanism.tool)]


def _fixed_frame(
    i: int,
    roles: tuple[Role, ...],
    convention: Convention,
    mechanism: Mechanism,
    fixed: Iterator[Matrices],
) -> Matrices | None:
    """The frame that a fixed row behind the last joint should start from, where that is known.

    Of a modified table's last row only Z is left for the last step, so its z lies on the tool's.
    """
    if any(role.joint for role in roles[i:]):
        return None
    if convention is Convention.MODIFIED and i == len(roles) - 1:
        return mechanism.tool
    return next(fixed, None)
