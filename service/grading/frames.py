"""A handed-in table under frames of the student's own choice.

Turns the table's rows into what ``kinematics.frame_choice`` searches with, and its answer back into
what each cell should have been, in the student's own frames.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.grading.compare import Numbers
from service.grading.free_base import own_bases
from service.grading.freedom import Freedom
from service.grading.mechanism import Mechanism, as_table, regrouped
from service.grading.roles import Role, variable_column
from service.grading.samples import Samples
from service.grading.written import Written, without_motion, written_constants, written_rows
from service.kinematics.chain import Table
from service.kinematics.dh import Convention
from service.kinematics.fit import Place, Position, positions
from service.kinematics.frame_choice import (
    NO_SUCH_CELL,
    WRONG_CELL,
    departure,
    nearest_table,
)
from service.kinematics.mending import single_mends
from service.kinematics.transforms import Matrices
from service.kinematics.walk import (
    Nearest,
    Stop,
    followed,
    senses_of,
    valid_as_it_stands,
)

# What multiplying a cell out of all the others may cost in figures.
MENDED = 1e-6


@dataclass(frozen=True, slots=True)
class FrameReading:
    """A table read in the student's own frames: ``expected`` is ``(rows, 4, LANES)``.

    ``poses`` are where the student's frames at the joints lie in the reference's, each
    ``(SAMPLES, 4, 4)``. ``cost`` is that of ``frame_choice``: below 1 the table is valid.
    ``shared`` ``(rows,)`` says whose axis has a parallel neighbour: offsets along it add up.
    """

    roles: tuple[Role, ...]
    expected: Table
    poses: tuple[Matrices, ...]
    cost: float
    shared: NDArray[np.bool_]


def read_in_own_frames(
    roles: tuple[Role, ...],
    joints: tuple[Joint, ...],
    convention: Convention,
    mechanism: Mechanism,
    freedom: Freedom,
) -> FrameReading:
    """The valid table nearest to the one handed in."""
    written = written_constants(roles, joints, mechanism.samples)
    stops = _stops(roles, convention, mechanism, freedom)
    rows = written_rows(roles, written, convention)
    directions_given, base_given = not freedom.directions, not freedom.base
    scale = mechanism.length_scale
    starts = [None] if base_given else own_bases(roles, joints, convention, mechanism, freedom)
    nearest = None
    for start in starts:
        nearest = nearest or valid_as_it_stands(
            rows, stops, scale, directions_given=directions_given, start=start
        )
    if nearest is None and freedom == Freedom():
        nearest = _nearest_by_one_cell(roles, convention, stops, mechanism)
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
        poses=tuple(
            pose for pose, role in zip(nearest.poses, roles, strict=False) if role.joint is not None
        ),
        cost=nearest.cost,
        shared=_with_parallel_neighbour(roles, mechanism),
    )


def _nearest_by_one_cell(
    roles: tuple[Role, ...], convention: Convention, stops: list[Stop], mechanism: Mechanism
) -> Nearest | None:
    """The valid table that differs from the one handed in by one cell, wrong or not to be read.

    Where there are several, the one in which the student's frames are nearest to the reference's.
    """
    if not all(role.row for role in roles):
        return None
    handed_in = np.array([role.row.values for role in roles if role.row])
    unread = np.isnan(handed_in).any(axis=-1)
    if np.count_nonzero(unread) > 1:
        return None
    table = np.where(unread[..., None], 0.0, handed_in)
    mends, values = single_mends(table, convention, mechanism.pose, mechanism.length_scale)
    if unread.any():
        mends &= unread
    cells = np.argwhere(mends)
    if not len(cells):
        return None
    tables = np.repeat(table[None], len(cells), axis=0)
    for mended, (i, column) in zip(tables, cells, strict=True):
        mended[i, column] = values[i, column]
    own, senses = without_motion(tables, roles, mechanism.samples)
    links = np.moveaxis(regrouped(np.moveaxis(own, 0, -1), convention, 0.0), -1, 0)
    senses = np.pad(senses, ((0, 0), (1, 0)))
    valid, poses = followed(links, senses, stops, mechanism.length_scale, MENDED)
    if not valid.any():
        return None
    departures = np.array([departure(p, mechanism.length_scale) for p in poses[:-1]]).sum(axis=0)
    best = int(np.argmin(np.where(valid, departures, np.inf)))
    return Nearest(
        rows=tuple(links[best]),
        senses=tuple(int(senses_of(pose)[best]) for pose in poses),
        poses=tuple(poses[:, best]),
        cost=WRONG_CELL + float(departures[best]),
    )


def _with_parallel_neighbour(roles: tuple[Role, ...], mechanism: Mechanism) -> NDArray[np.bool_]:
    """Which rows' axes are parallel to the axis before or behind."""
    to_next = np.array([*mechanism.joints[1:], mechanism.tool])
    skew = positions(to_next, mechanism.length_scale) == Position.SKEW
    beside = ~np.array([skew, np.roll(skew, 1)])
    beside[1, 0] = False
    of_joints = iter(np.asarray(beside.any(axis=0)))
    return np.array([role.joint is not None and bool(next(of_joints)) for role in roles])


def valid_tables(
    tables: Numbers,
    roles: tuple[Role, ...],
    convention: Convention,
    mechanism: Mechanism,
    freedom: Freedom,
    tolerance: float,
) -> NDArray[np.bool_]:
    """Which of many tables describe the mechanism, in whatever frames: ``(T,)``.

    ``tables`` is ``(T, rows, 4, lanes)`` at the mechanism's samples, all with the same rows for the
    same joints. A free base is not looked into here: it counts as given.
    """
    own, senses = without_motion(tables, roles, mechanism.samples)
    if freedom.directions:
        senses = np.zeros_like(senses)
    stops = _stops(roles, convention, mechanism, freedom)
    links = np.moveaxis(regrouped(np.moveaxis(own, 0, -1), convention, 0.0), -1, 0)
    return followed(
        links, np.pad(senses, ((0, 0), (1, 0))), stops, mechanism.length_scale, tolerance
    )[0]


def _stops(
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


def _expected(
    roles: tuple[Role, ...],
    nearest: Nearest,
    written: Written,
    convention: Convention,
    samples: Samples,
    freedom: Freedom,
) -> Table:
    """What each cell should be, joint variables and all: ``(rows, 4, LANES)``."""
    table = np.tile(as_table(nearest.rows, convention), 2)
    for i, role in enumerate(roles):
        if role.joint is not None:
            sense = nearest.senses[i]
            if freedom.directions and written.senses[i]:
                sense = int(written.senses[i])
            table[i, variable_column(role.joint)] += sense * samples.values[role.joint.variable]
    return table
