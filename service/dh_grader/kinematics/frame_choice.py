"""Which DH rows describe the same robot: the correct table nearest to the student's table.

A beam over the rows compares a student's chain of links with the reference, link by link. It knows
numbers only: what they say of a student's cells is for the grading.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum, IntEnum
from typing import Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from dh_grader.kinematics import (
    ALONG_NORMAL,
    ALPHA,
    CLEARLY_NOT_PARALLEL,
    EXACT_CELL,
    NOT_PARALLEL_BY_ROUNDING,
    PARALLEL,
    ROUNDED_CELL,
    SAME_HYPOTHESIS,
    SAME_POSE,
    THETA,
    A,
    Convention,
    D,
    Matrices,
    Numbers,
    identity,
    inverse,
    is_unreachable,
    rot_x,
    row,
    standard_link,
)

# --- Compare a student's chain of links with the reference solution, link by link
#
# The *relative pose* at a joint is the pose of the student's frame in the reference's frame there.
#
# Shapes: L samples; a row is ``(4, L)`` with the columns a, α, d, θ.
#
# A chain is T(q) = C_0 M_1(q_1) C_1 … M_n(q_n) C_n with constant links C_i. Two tables describe one
# mechanism if and only if constant transforms g_i exist with C_i(written) = g_i⁻¹ C_i(reference)
# g_{i+1}, where g_i keeps joint axis i (docs/frame-choice.md). So g_{i+1} follows from g_i and the
# written link, and must keep its axis. In the code g_i is the relative pose.
#
# A row stands for the product Z X that leads from one target to the next; angles in radians.


class TargetKind(Enum):
    """What a row of the table leads to, for example a revolute axis or the tool frame."""

    REVOLUTE = "a line that the next z axis lies on"
    PRISMATIC = "a direction of the next z axis"
    FIXED = "a frame of a fixed row, which may be anywhere"
    TOOL = "the given end-effector frame"
    OPEN = "an end-effector frame of the student's choice"


@dataclass(frozen=True, slots=True)
class Target:
    """The axis or frame to which a row of the table leads."""

    kind: TargetKind
    # The reference's transform (L, 4, 4) from the previous joint's frame to the target's frame;
    # None for a fixed frame that the reference does not have.
    reference: Matrices | None

    @property
    def rebases(self) -> bool:
        """True if the transform to the next target starts from the frame at this target."""
        return self.reference is not None and self.kind is not TargetKind.FIXED


@dataclass(frozen=True, slots=True)
class RowConstants:
    """The constants in a row of the student's table, with facts about each cell."""

    # (4, L), NaN in a cell without a usable number.
    written: Numbers
    # (4,), as the next three: True for cells that can be right or wrong.
    is_gradable: NDArray[np.bool_]
    # True for cells that are wrong whatever frames are chosen.
    wrong_regardless: NDArray[np.bool_]
    # True for cells that the table does not have (they are 0).
    absent: NDArray[np.bool_]
    # The rounding error of each cell.
    slack: Numbers
    # The column of the row's joint variable, or None.
    variable: int | None
    # The sign of the joint variable: +1, -1, or 0 if unknown.
    joint_sign: int


@dataclass(frozen=True, slots=True)
class ChainMatch:
    """A correct table, and the poses of its frames in the frames of the reference solution."""

    # (rows, 4, L).
    rows: Numbers
    # The relative pose at each target, (rows, L, 4, 4).
    relative_poses: Matrices
    # The distance of the written table from this table.
    cost: float
    # The units of marks that the written table loses.
    lost: float = 0.0

    @property
    def joint_signs(self) -> list[int]:
        """The correct sign of the joint variable in each row."""
        signs: list[int] = joint_signs_of(self.relative_poses).tolist()
        return signs


def match_as_written(
    rows: Sequence[RowConstants],
    targets: Sequence[Target],
    length_scale: float,
    *,
    directions_given: bool = True,
    start: Matrices | None = None,
) -> ChainMatch | None:
    """Return the student's table if nothing in it is wrong, else None."""
    # directions_given is true if each joint's positive direction is given. start is the relative
    # pose of frame 0, None for the identity.
    if any(row.wrong_regardless.any() for row in rows):
        return None
    written = np.array([row.written for row in rows])
    signs = np.array([row.joint_sign if directions_given else 0 for row in rows])
    valid, poses = match_tables(written[None], signs[None], targets, length_scale, start=start)
    return ChainMatch(written, poses[:, 0], 0.0) if valid[0] else None


def match_tables(
    written: Numbers,
    joint_signs: NDArray[np.int_],
    targets: Sequence[Target],
    length_scale: float,
    tolerance: float = SAME_POSE,
    start: Matrices | None = None,
) -> tuple[NDArray[np.bool_], Matrices]:
    """Test which of many tables are correct.

    Return a mask ``(tables,)`` and the poses of the tables' frames in the reference solution's
    frames, ``(rows, tables, samples, 4, 4)``.
    """
    # written is (tables, rows, 4, L). joint_signs (tables, rows) are +1 or -1, or 0 where the sign
    # is unknown or the direction is free. start (L, 4, 4), or one for each table, is the relative
    # pose of frame 0, None for the identity. A table with NaN is not correct.
    count = written.shape[-1]
    links = standard_link(*np.moveaxis(written, 2, 0))
    pose = identity((len(written), count))
    if start is not None:
        pose[:] = start
    poses = np.empty((len(targets), *pose.shape))
    for i, target in enumerate(targets):
        pose = pose @ links[:, i]
        if target.reference is not None and target.rebases:
            pose = inverse(target.reference[:count]) @ pose
        poses[i] = pose
    valid = np.ones(len(written), dtype=np.bool_)
    for i, target in enumerate(targets):
        valid &= _error_at(poses[i], target.kind, length_scale) <= tolerance
        if i > 0:
            valid &= joint_signs[:, i] * joint_signs_of(poses[i - 1]) >= 0
    return valid, poses


def misfits(poses: Matrices, targets: Sequence[Target], length_scale: float) -> Numbers:
    """Return the n errors in the frames of each table, ``(tables, n, samples)``."""
    # poses (rows, tables, L, 4, 4) are the relative poses that match_tables returns. The directions
    # of the axes are ignored.
    unit = np.array([1.0, 1.0, 1.0, length_scale])
    missed: list[Numbers] = []
    for pose, target in zip(poses, targets, strict=True):
        if target.kind is TargetKind.TOOL:
            difference = (pose - np.eye(4))[..., :3, :] / unit
            missed.append(difference.reshape(*pose.shape[:2], -1))
        elif target.kind is TargetKind.REVOLUTE:
            off_axis = pose[..., :2, 2:] / unit[2:]
            missed.append(off_axis.reshape(*pose.shape[:2], -1))
        elif target.kind is TargetKind.PRISMATIC:
            missed.append(pose[..., :2, 2])
    return np.asarray(np.swapaxes(np.concatenate(missed, axis=-1), 1, 2))


def _error_at(pose: Matrices, kind: TargetKind, length_scale: float) -> Numbers:
    error: Numbers = np.abs(pose[:, :, :2, 2]).max(axis=(1, 2))
    if kind in (TargetKind.FIXED, TargetKind.OPEN):
        return np.where(np.isnan(error), np.nan, 0.0)
    if kind is not TargetKind.PRISMATIC:
        error = np.maximum(error, np.abs(pose[:, :, :2, 3]).max(axis=(1, 2)) / length_scale)
    if kind is TargetKind.TOOL:
        error = np.maximum(error, np.abs(pose - np.eye(4)).max(axis=(1, 2, 3)))
    return error


def joint_signs_of(pose: Matrices) -> NDArray[np.int_]:
    """Return +1 for each frame with the reference frame's z direction, −1 for the opposite one."""
    return np.where(pose[:, 0, 2, 2] > 0, 1, -1)


# --- Keep track of the positions that a freely chosen frame 0 may still have
#
# Frame 0 may be turned about the axis of joint 1 and moved along this axis.
#
# Shapes: N candidate rows, L samples; rows are ``(N, 4, L)`` with the columns a, α, d, θ.
#
# If joint 1 is prismatic, frame 0 may be moved anywhere. The choice has an effect only where the
# chain first leaves the axis of joint 1. So the search keeps the freedom from row to row until a
# row depends on it; this row uses it up.


@dataclass(frozen=True, slots=True)
class BaseFreedom:
    """The ways in which a frame that the student chose may be moved."""

    # True if the frame may be turned about z.
    turn: bool = False
    # The frame may be moved along this vector (L, 3), given in the reference's frame on the same
    # axis.
    slide: Numbers | None = None
    # True if the frame may be moved in all directions.
    anywhere: bool = False

    @classmethod
    def on_first_axis(cls, prismatic: bool, samples: int) -> Self:
        """Return how a freely chosen frame on the axis of joint 1 may be moved."""
        return cls(turn=True, slide=None if prismatic else _along_z(samples), anywhere=prismatic)

    @property
    def is_used_up(self) -> bool:
        """True if the frame may not be moved."""
        return not (self.turn or self.anywhere) and self.slide is None

    def at_next(self, reference: Matrices, kind: TargetKind, length_scale: float) -> Self:
        """Return how the student's frame on the next axis may be moved."""
        relation = axis_relations(reference[None], length_scale)[0]
        parallel = relation != AxisRelation.SKEW
        sliding = kind is TargetKind.PRISMATIC
        turn = self.turn and (
            relation == AxisRelation.COINCIDENT or (parallel and (sliding or self.anywhere))
        )
        if self.anywhere:
            return type(self)(turn, None if sliding else _along_z(len(reference)), anywhere=sliding)
        if self.slide is None:
            return type(self)(turn)
        slide = (np.swapaxes(reference[:, :3, :3], -1, -2) @ self.slide[..., None])[..., 0]
        still_along_z = np.abs(slide[:, :2]).max() < PARALLEL
        return type(self)(turn, slide if sliding or still_along_z else None)

    def use_up(
        self, rows: Numbers, rows_beyond: Numbers, written: Numbers
    ) -> list[tuple[Numbers, Numbers]]:
        """Return rows of moved frames, each with the distance of the frame along ``slide``.

        Each distance makes one length in the row equal to the ``written`` length. Distances are
        ``(N, L)`` for N rows at L samples.
        """
        # rows_beyond is rows for a frame one unit further along slide; lengths depend linearly on
        # the distance.
        unmoved = np.zeros(rows.shape[::2])
        if self.anywhere:
            moved = rows.copy()
            moved[:, [A, D]] = written_or(written[[A, D]], rows[:, [A, D]])
            return [(moved, unmoved)]
        if self.slide is None:
            return [(rows, unmoved)]
        options = []
        for column in (A, D):
            rate = rows_beyond[:, column] - rows[:, column]
            if np.abs(rate).min() < PARALLEL or np.isnan(written[column]).any():
                continue
            distance = (written[column] - rows[:, column]) / rate
            options.append((rows + distance[:, None] * (rows_beyond - rows), distance))
        return options or [(rows, unmoved)]

    def with_written_angle(self, rows: Numbers, written: Numbers) -> Numbers:
        """Return the rows with the written θ if every angle is allowed; else unchanged."""
        if not self.turn:
            return rows
        turned = rows.copy()
        turned[:, THETA] = written_or(written[THETA], rows[:, THETA])
        return turned


def _along_z(samples: int) -> Numbers:
    return np.broadcast_to(np.array([0.0, 0.0, 1.0]), (samples, 3))


# --- Find the correct table that is nearest to the student's table
#
# Students may choose their own frames. The search goes from the base to the tool, and keeps only
# the best candidates: it is a beam search.
#
# Shapes: H candidates, N ways to continue them, L samples; a row is ``(4, L)`` with the columns a,
# α, d, θ. Angles are in radians.
#
# Each written row is compared with all rows that are valid for the frames chosen so far. A wrong
# cell costs 1. Each further wrong cell in the same row costs less, so that one wrong row is cheaper
# than errors in several rows. A frame other than the reference's frame has a small cost, so that an
# uncompensated shift is found in the row where it was made.


# The columns of the two angles in a row.
_ANGLES = slice(ALPHA, None, THETA - ALPHA)
BEAM_WIDTH = 8
MAX_CONTINUATIONS = 20
# A hypothesis that costs this much more than the best is dropped: it needs as many more slips.
MAX_COST_BEHIND = 2.5

# The costs of a hypothesis. A slip cannot be in a cell that the table does not have, so that a
# hypothesis which needs such a cell is a last resort.
WRONG_CELL = 1.0
# The cost of 0 to 4 wrong cells in one row of the table; several rows cost more.
ROW_COSTS = WRONG_CELL * np.array([0.0, 1.0, 1.9, 2.7, 3.4])
# The search also keeps the SPARING hypotheses that lose the fewest marks. A row loses 1 for each
# wrong cell, but for several cells at most BESIDES plus 1 for each cell that is not 0.
BESIDES = 0.2
NOT_ZERO = 1e-9
SPARING = 4
# For each hypothesis that is continued, the ones before it.
_EARLIER = np.tri(MAX_CONTINUATIONS + 2 * SPARING, k=-1, dtype=np.bool_)
# The weight of the cost between hypotheses that lose the same marks: the cheaper one is kept.
SAME_LOSS = 1e-3
NO_SUCH_CELL = 3.0
UNREACHABLE = 3.0
TURNED_OVER = 0.010
TURNED_ABOUT = 0.004
MOVED = 0.020

# For each row so far, its right values and the relative pose after it.
_Path = tuple[tuple[Numbers, Matrices], ...]


@dataclass(frozen=True, slots=True)
class _Beam:
    # The relative poses of the H hypotheses, (H, L, 4, 4).
    pose: Matrices
    cost: Numbers
    # The marks (H,) that the student loses: 1 for each wrong or unread cell, with a limit for each
    # row.
    lost: Numbers
    paths: list[_Path]
    # The cells among a and α, if only these two of a table row have been compared yet.
    begun: "_RowCounts"


@dataclass(frozen=True, slots=True)
class _RowCounts:
    # The numbers (N,) of wrong, unread and nonzero cells in a row of the table.
    wrong: NDArray[np.int_]
    unread: NDArray[np.int_]
    known: NDArray[np.int_]

    @classmethod
    def none(cls, count: int) -> "_RowCounts":
        zeros = np.zeros(count, np.int_)
        return cls(zeros, zeros, zeros)

    @property
    def cost(self) -> Numbers:
        return np.asarray(ROW_COSTS[self.wrong])

    @property
    def lost(self) -> Numbers:
        count = self.wrong + self.unread
        return np.where(count > 1, np.minimum(BESIDES + self.known, count), count)

    def at(self, which: NDArray[np.int_]) -> "_RowCounts":
        return _RowCounts(self.wrong[which], self.unread[which], self.known[which])

    def __add__(self, other: "_RowCounts") -> "_RowCounts":
        return _RowCounts(
            self.wrong + other.wrong, self.unread + other.unread, self.known + other.known
        )


def nearest_table(
    rows: Sequence[RowConstants],
    targets: Sequence[Target],
    length_scale: float,
    *,
    base_given: bool = True,
    directions_given: bool = True,
    start: Matrices | None = None,
    z_ends_rows: bool = False,
) -> ChainMatch:
    """Return the correct table that is nearest to the written ``rows``."""
    # z_ends_rows is true if a and α come before d and θ in each row of the table. base_given is
    # true if frame 0 is known. Its pose in the reference's frame 0 is start (L, 4, 4), or the
    # identity if start is None. directions_given is true if each joint's positive direction is
    # given, so that a reversed z axis needs a variable with the opposite sign.
    samples = rows[0].written.shape[-1]
    if base_given:
        pose = identity((samples,)) if start is None else start
        none = np.zeros(1)
        beam, freedom = _Beam(pose[None], none, none, [()], _RowCounts.none(1)), BaseFreedom()
        remaining = list(zip(rows, targets, strict=True))
    else:
        beam, freedom = _from_free_base(rows[0], targets[0])
        remaining = list(zip(rows[1:], targets[1:], strict=True))
    for constants, target in remaining:
        beam = _next_beam(
            beam, constants, target, length_scale, directions_given, freedom, z_ends_rows
        )
        if target.reference is not None and target.rebases and not freedom.is_used_up:
            freedom = freedom.at_next(target.reference, target.kind, length_scale)
    best = int(np.argmin(beam.cost))
    valid_rows, poses = map(np.array, zip(*beam.paths[best], strict=True))
    return ChainMatch(valid_rows, poses, float(beam.cost[best]), float(beam.lost.min()))


def _from_free_base(first: RowConstants, target: Target) -> tuple[_Beam, BaseFreedom]:
    # The row from a free base to the first axis is always right; z has either direction.
    samples = first.written.shape[-1]
    poses = np.stack([identity((samples,)), rot_x(np.full(samples, np.pi))])
    row = np.nan_to_num(first.written)
    paths: list[_Path] = [((row, pose),) for pose in poses]
    beam = _Beam(poses, np.array([0.0, TURNED_OVER]), np.zeros(2), paths, _RowCounts.none(2))
    return beam, BaseFreedom.on_first_axis(target.kind is TargetKind.PRISMATIC, samples)


def _next_beam(
    beam: _Beam,
    row: RowConstants,
    target: Target,
    length_scale: float,
    directions_given: bool,
    freedom: BaseFreedom,
    z_ends_rows: bool,
) -> _Beam:
    parents, rows, distance, unreachable = _continuations(beam, row, target, length_scale, freedom)
    expected = freedom.with_written_angle(rows, row.written)
    wrong = _wrong_cells(row, expected, length_scale)
    if row.variable is not None and directions_given:
        wrong[:, row.variable] |= row.joint_sign * joint_signs_of(beam.pose)[parents] < 0
    wrong |= row.wrong_regardless
    of_x, of_z = _counts(wrong, expected, row, length_scale, free_angle=freedom.turn)
    before = beam.begun.at(parents)
    if z_ends_rows:
        rows_done = [(before + of_z, 1), (before, -1), (of_x, 1)]
        begun = of_x
    else:
        rows_done = [(of_z + of_x, 1)]
        begun = _RowCounts.none(len(parents))
    cost = beam.cost[parents] + sum(sign * each.cost for each, sign in rows_done)
    lost = beam.lost[parents] + sum(sign * each.lost for each, sign in rows_done)
    last_resort = NO_SUCH_CELL * (wrong & row.absent).sum(axis=1) + UNREACHABLE * unreachable
    cost, lost = cost + last_resort, lost + last_resort
    order = np.argsort(cost, kind="stable")[:MAX_CONTINUATIONS]
    order = order[cost[order] <= cost[order[0]] + MAX_COST_BEHIND]
    by_loss = np.argsort(lost + SAME_LOSS * cost, kind="stable")[: 2 * SPARING]
    kept = _with_others(order, by_loss)
    parents, expected, begun = parents[kept], expected[kept], begun.at(kept)
    cost, lost = cost[kept], lost[kept]
    start = _slid(beam.pose[parents], freedom, distance[kept])
    pose = start @ standard_link(*rows[kept].swapaxes(0, 1))
    if target.reference is not None:
        relative = inverse(target.reference) @ pose
        if target.rebases:
            pose = relative
            if freedom.anywhere:
                pose[..., :3, 3] = 0.0
        cost = cost + departure(relative, length_scale)
    is_same = _same_frames(pose, length_scale)
    sparing = _distinct(is_same, lost + SAME_LOSS * cost)[:SPARING]
    kept = _with_others(_distinct(is_same, cost), sparing)
    paths = [(*beam.paths[parents[i]], (expected[i], pose[i])) for i in kept]
    return _Beam(pose[kept], cost[kept], lost[kept], paths, begun.at(kept))


def _with_others(chosen: NDArray[np.int_], others: NDArray[np.int_]) -> NDArray[np.int_]:
    is_new = (others[:, None] != chosen).all(axis=1)
    return np.concatenate([chosen, others[is_new]])


def _counts(
    wrong: NDArray[np.bool_],
    expected: Numbers,
    row: RowConstants,
    length_scale: float,
    *,
    free_angle: bool,
) -> tuple[_RowCounts, _RowCounts]:
    # Counts wrong, unread and nonzero cells: first among a and α, then among d and θ.
    of_first = expected[..., 0] / np.array([length_scale, 1.0, length_scale, 1.0])
    of_first[:, _ANGLES] = np.sin(of_first[:, _ANGLES] / 2)
    # A constant beside a wrong joint variable does not count.
    known = (np.abs(of_first) > NOT_ZERO) & ~row.wrong_regardless
    if free_angle:
        # In a wrong row, the angle could as well be 0.
        known[:, THETA] &= wrong[:, THETA]
    unread = np.broadcast_to(~(row.is_gradable | row.absent), wrong.shape)
    counts = [wrong & row.is_gradable, unread, known]
    halves = [each.reshape(-1, 2, 2).sum(axis=2) for each in counts]
    of_x, of_z = (_RowCounts(*(half[:, part] for half in halves)) for part in (0, 1))
    return of_x, of_z


def _continuations(
    beam: _Beam, row: RowConstants, target: Target, length_scale: float, freedom: BaseFreedom
) -> tuple[NDArray[np.int_], Numbers, Numbers, NDArray[np.bool_]]:
    # For each of the N ways, returns the index of its hypothesis (N,), its row (N, 4, L), the
    # distance (N, L) to slide the frame along the remaining freedom of the base, and a mask (N,) of
    # the ways in which no row leads to the target.
    reference = target.reference
    if reference is None:
        rows = np.broadcast_to(np.nan_to_num(row.written), (len(beam.pose), *row.written.shape))
        nowhere = np.zeros((len(rows), rows.shape[-1]))
        return np.arange(len(rows)), rows, nowhere, np.zeros(len(rows), np.bool_)
    seen = inverse(beam.pose) @ reference
    relations = axis_relations(seen, length_scale)
    found = []
    for relation in sorted(set(relations.tolist())):
        members = np.flatnonzero(relations == relation)
        here = seen[members]
        candidates = candidate_rows(here, row.written, target.kind, length_scale)
        parents = np.repeat(members, candidates.shape[1])
        rows = candidates.reshape(-1, *candidates.shape[2:])
        beyond = candidates
        if freedom.slide is not None:
            step = np.ones(here.shape[:2])
            there = inverse(_slid(beam.pose[members], freedom, step)) @ reference
            beyond = candidate_rows(there, row.written, target.kind, length_scale)
            # One step aside the axes may lie differently; then there is nothing to compare with.
            beyond = beyond if beyond.shape == candidates.shape else candidates
        for chosen, distance in freedom.use_up(rows, beyond.reshape(rows.shape), row.written):
            if target.kind is TargetKind.TOOL:
                reached = inverse(_slid(beam.pose[parents], freedom, distance)) @ reference
                unreachable = is_unreachable(reached, length_scale) & (not freedom.anywhere)
            else:
                unreachable = np.zeros(len(parents), np.bool_)
            found.append((parents, chosen, distance, unreachable))
    parents, rows, distances, unreachable = map(np.concatenate, zip(*found, strict=True))
    return parents, rows, distances, unreachable


def _slid(pose: Matrices, freedom: BaseFreedom, distance: Numbers) -> Matrices:
    if freedom.slide is None:
        return pose
    moved = pose.copy()
    moved[..., :3, 3] += distance[..., None] * freedom.slide
    return moved


def _wrong_cells(row: RowConstants, rows: Numbers, length_scale: float) -> NDArray[np.bool_]:
    error = row.written - rows
    np.abs(error, out=error)
    turns = error[:, _ANGLES] / (2 * np.pi)
    turns -= np.round(turns)
    error[:, _ANGLES] = 2 * np.pi * np.abs(turns, out=turns)
    scale = np.array([length_scale, 1.0, length_scale, 1.0])
    # The cells from which this one is computed may be rounded, too.
    slack = np.where(row.slack > 0, np.maximum(row.slack, ROUNDED_CELL * scale), EXACT_CELL * scale)
    with np.errstate(invalid="ignore"):
        right = error.max(axis=-1) <= slack
    return np.asarray(~right)


def departure(pose: Matrices, length_scale: float) -> Numbers:
    """Return, for each pose, the small cost of a frame that is not the reference solution's."""
    # pose (N, L, 4, 4) are the relative poses of the frames.
    # An axis at a right angle is not reversed, whatever the rounding error of its cosine is.
    cost = np.where(pose[:, 0, 2, 2] < -SAME_POSE, TURNED_OVER, 0.0)
    cost += np.where(pose[:, 0, 0, 0] < -SAME_POSE, TURNED_ABOUT, 0.0)
    turned = np.abs(pose[:, :, 1, 0]).max(axis=-1) > SAME_POSE
    moved = np.abs(pose[:, :, :3, 3]).max(axis=(-1, -2)) > SAME_POSE * length_scale
    return np.asarray(cost + MOVED * (turned.astype(np.float64) + moved))


def _same_frames(pose: Matrices, length_scale: float) -> NDArray[np.bool_]:
    # The pairs (H, H) of hypotheses with the same frame in the first sample.
    frames = pose[:, 0, :3].reshape(len(pose), -1)
    difference = frames[:, None] - frames[None]
    np.abs(difference, out=difference)
    return np.asarray(~(difference.max(axis=-1) > SAME_HYPOTHESIS * max(1.0, length_scale)))


def _distinct(is_same: NDArray[np.bool_], cost: Numbers) -> NDArray[np.int_]:
    # The best hypotheses, each only once.
    order = np.argsort(cost, kind="stable")
    is_again = (is_same[order[:, None], order] & _EARLIER[: len(order), : len(order)]).any(axis=1)
    return np.asarray(order[~is_again][:BEAM_WIDTH])


# --- Find all DH rows that lead from a frame to the next joint axis, or to the tool
#
# Shapes: H hypotheses, K candidates for each, L samples; rows are ``(..., 4, L)`` with the columns
# a, α, d, θ.
#
# A row moves by Rot_z(θ) Trans_z(d) Trans_x(a) Rot_x(α). The next target is a transform relative to
# the frame before the row. Its kind decides what the row must match: the line of a revolute axis,
# the direction of a prismatic axis, or the whole frame of the tool. A value is called open if the
# geometry does not determine it. Then the written value is as good as the reference's value, so
# both are tried.
#
# The written row is (4, L), with NaN for cells without a usable number. Angles are in radians.


_X_SIGNS = np.array([[1.0], [-1.0], [1.0], [-1.0]])
_Z_SIGNS = np.array([[1.0], [1.0], [-1.0], [-1.0]])


class AxisRelation(IntEnum):
    """The relative position of two axes."""

    SKEW = 0
    PARALLEL = 1
    COINCIDENT = 2


def candidate_rows(
    target: Matrices, written: Numbers, kind: TargetKind, length_scale: float
) -> Numbers:
    """Return all DH rows that lead to the next axes ``target``: ``(H, K, 4, L)``.

    There are K candidates for each of H hypotheses, at L samples. All axes in ``target`` must have
    the same ``AxisRelation`` to the previous z axis.
    """
    if kind is TargetKind.TOOL:
        return row(target, Convention.STANDARD)[:, None]
    if kind is TargetKind.OPEN:
        return written_or(written, row(target, Convention.STANDARD)[:, None])
    relation = AxisRelation(axis_relations(target[:1], length_scale)[0])
    if kind is TargetKind.PRISMATIC:
        if relation is AxisRelation.SKEW:
            return _with_open_lengths(_to_skew(target, written), written)
        return _to_parallel_direction(target, written, relation)
    rows = _TO_LINE[relation](target, written)
    if kind is TargetKind.FIXED and not np.isnan(written).any():
        as_written = np.broadcast_to(written, (len(target), 1, *written.shape))
        unmoved = as_written.copy()
        unmoved[:, :, D:] = 0.0
        rows = np.concatenate([as_written, unmoved, rows], axis=1)
    return rows


def axis_relations(target: Matrices, length_scale: float) -> NDArray[np.int_]:
    """Return the relation of the next z axis to the previous one, for each hypothesis."""
    sine = np.hypot(target[..., 0, 2], target[..., 1, 2])
    offset = np.hypot(target[..., 0, 3], target[..., 1, 3])
    parallel = np.all(sine < PARALLEL, axis=-1)
    coincident = parallel & np.all(offset < PARALLEL * length_scale, axis=-1)
    found: NDArray[np.int_] = np.add(parallel, coincident, dtype=np.int_)
    return found


def written_or(written: Numbers, other: Numbers) -> Numbers:
    """Return ``written`` with each NaN replaced by the value in ``other``."""
    return np.where(np.isnan(written), other, written)


def _to_skew(target: Matrices, written: Numbers) -> Numbers:
    # x is along the common normal. Both x and z may be reversed.
    ux, uy, uz = (target[..., i, 2] for i in range(3))
    px, py, pz = (target[..., i, 3] for i in range(3))
    sine = np.hypot(ux, uy)
    theta = np.arctan2(ux, -uy)
    a = (py * ux - px * uy) / sine
    x_sign, z_sign = _signs(target, theta, a, written)
    alpha = np.arctan2(x_sign * z_sign * sine[:, None], z_sign * uz[:, None])
    d = pz - uz * (px * ux + py * uy) / sine**2
    return _rows(x_sign * a[:, None], alpha, d[:, None], _half_turned(theta, x_sign))


def _to_parallel(target: Matrices, written: Numbers) -> Numbers:
    # x points from one axis to the other. d is open: the written and the reference's d are tried.
    px, py, pz = (target[..., i, 3] for i in range(3))
    theta, a = np.arctan2(py, px), np.hypot(px, py)
    x_sign, z_sign = _signs(target, theta, a, written)
    alpha = _parallel_twist(target, z_sign)
    return np.concatenate(
        [
            _rows(x_sign * a[:, None], alpha, d[:, None], _half_turned(theta, x_sign))
            for d in (written_or(written[D], pz), pz)
        ],
        axis=1,
    )


def _to_coincident(target: Matrices, written: Numbers) -> Numbers:
    # θ and d are open: the written and the reference's values are tried.
    pz = target[..., 2, 3]
    x_angle = np.arctan2(target[..., 1, 0], target[..., 0, 0])
    alpha = _parallel_twist(target, _Z_SIGNS)
    theta = _half_turned(x_angle, _X_SIGNS * np.ones_like(alpha))
    return np.concatenate(
        [
            _rows(np.zeros(1), alpha, d[:, None], angle)
            for d in (written_or(written[D], pz), pz)
            for angle in (written_or(written[THETA], theta), theta)
        ],
        axis=1,
    )


_TO_LINE = {
    AxisRelation.SKEW: _to_skew,
    AxisRelation.PARALLEL: _to_parallel,
    AxisRelation.COINCIDENT: _to_coincident,
}


def _with_open_lengths(rows: Numbers, written: Numbers) -> Numbers:
    # The rows turn z to a given direction that is not parallel to z. a and d are open, because only
    # the direction is given. Each of them is taken as written or from rows, in all combinations.
    options = []
    for columns in ((A, D), (A,), (D,), ()):
        moved = rows.copy()
        for column in columns:
            moved[:, :, column] = written_or(written[column], rows[:, :, column])
        options.append(moved)
    return np.concatenate(options, axis=1)


def _to_parallel_direction(target: Matrices, written: Numbers, relation: AxisRelation) -> Numbers:
    # a, d and θ are open, because only the direction is given.
    on_line = _TO_LINE[relation](target, written)
    as_written = np.empty((len(target), 2, 4, target.shape[1]))
    as_written[:] = written_or(written, on_line[:, :1])
    as_written[:, :, ALPHA] = _parallel_twist(target, np.array([[1.0], [-1.0]]))
    with_reference_offset = as_written.copy()
    with_reference_offset[:, :, D] = target[:, None, :, 2, 3]
    with_written_length = on_line.copy()
    with_written_length[:, :, A] = written_or(written[A], on_line[:, :, A])
    return np.concatenate([as_written, with_reference_offset, with_written_length, on_line], axis=1)


def _signs(
    target: Matrices, theta: Numbers, a: Numbers, written: Numbers
) -> tuple[Numbers, Numbers]:
    # The possible signs of x and z: two arrays that broadcast to (H, K, L). x is along a normal at
    # the angle theta (H, L), where the link length is a, or points the opposite way. If a is a
    # difference of lengths, its sign may change between samples, but the direction of x does not.
    # So the first x that is tried points the same way as the reference's x. If the axis was moved,
    # the directions of the written θ and a are tried, too.
    x_angle = np.arctan2(target[..., 1, 0], target[..., 0, 0])
    along = np.cos(theta - x_angle)
    is_along = np.abs(np.abs(along) - 1).max(axis=-1, keepdims=True) < ALONG_NORMAL
    ways = [np.where(is_along, along, 1.0)]
    for way in (np.cos(theta - written[THETA]), a * written[A]):
        pattern = np.sign(way * ways[0])
        if not np.isnan(way).any() and np.ptp(pattern, axis=-1).any():
            ways.append(way)
    one_way = np.where(np.array(ways) < 0, -1.0, 1.0).swapaxes(0, 1)
    x_sign = np.concatenate([one_way, -one_way, one_way, -one_way], axis=1)
    z_sign = np.repeat([1.0, -1.0], 2 * len(ways))[:, None]
    return x_sign, z_sign


def _half_turned(theta: Numbers, x_sign: Numbers) -> Numbers:
    # theta (H, L), plus π where the sign of x (H, K, L) is negative.
    return theta[:, None] + np.where(x_sign < 0, np.pi, 0.0)


def _parallel_twist(target: Matrices, z_sign: Numbers) -> Numbers:
    # α between parallel axes, 0 or π, for each sign (K, 1): (H, K, L).
    return np.where(target[:, None, :, 2, 2] * z_sign > 0, 0.0, np.pi)


def _rows(a: Numbers, alpha: Numbers, d: Numbers, theta: Numbers) -> Numbers:
    # (H, K, 4, L).
    hypotheses, candidates, samples = np.broadcast(a, alpha, d, theta).shape
    rows = np.empty((hypotheses, candidates, 4, samples))
    rows[:, :, A], rows[:, :, ALPHA], rows[:, :, D], rows[:, :, THETA] = a, alpha, d, theta
    return rows


# --- The inverse of a chain of links, which leads from the tool to the base
#
# Shapes: L samples; cells are ``(rows, 4, ...)`` with the columns a, α, d, θ.
#
# The inverse of X_0 Z_1 X_1 … Z_m X_m is X_m⁻¹ Z_m⁻¹ … X_1⁻¹ Z_1⁻¹ X_0⁻¹, again an alternating
# product of screw motions about x and z. Its row j is the product Z X of Z_{m+1−j}⁻¹ and X_{m−j}⁻¹;
# the first row has no Z. Row j leads to the frame after Z_{m−j}, which is on the same axis as the
# frame before Z_{m−j}.


_Cell = TypeVar("_Cell", bound=np.generic)


def reversed_cells(cells: NDArray[_Cell]) -> NDArray[_Cell]:
    """Return the cells of a table, rearranged for the inverse of the table's pose."""
    # The signs are unchanged; the function is its own inverse.
    x, z = cells[::-1, :D], np.roll(cells[::-1, D:], 1, axis=0)
    return np.concatenate([x, z], axis=1)


def reversed_rows(rows: Sequence[RowConstants]) -> list[RowConstants]:
    """Return the rows of the inverse chain."""
    of_joints = [rows[0], *rows[:0:-1]]
    cells = zip(
        -reversed_cells(np.array([row.written for row in rows])),
        reversed_cells(np.array([row.is_gradable for row in rows])),
        reversed_cells(np.array([row.wrong_regardless for row in rows])),
        reversed_cells(np.array([row.absent for row in rows])),
        reversed_cells(np.array([row.slack for row in rows])),
        strict=True,
    )
    return [
        RowConstants(*row, joint.variable, joint.joint_sign)
        for row, joint in zip(cells, of_joints, strict=True)
    ]


def reversed_targets(targets: Sequence[Target], offsets: Matrices) -> list[Target]:
    """Return what each row of the inverse chain leads to, from the tool to the base.

    ``offsets`` ``(n, L, 4, 4)`` are Rot_z(θ) Trans_z(d) of n joints at L samples, from the
    reference solution's constants.
    """
    here = identity((offsets.shape[1],))
    each_offset = iter(offsets)
    passed = []
    for target in targets:
        frame = None if target.reference is None else here @ target.reference
        if frame is not None and target.rebases:
            here = frame
        if target.kind in (TargetKind.REVOLUTE, TargetKind.PRISMATIC) and frame is not None:
            frame = frame @ next(each_offset)
        passed.append((target, frame))
    found = []
    for target, frame in passed[-2::-1]:
        found.append(replace(target, reference=None if frame is None else inverse(here) @ frame))
        if frame is not None and target.rebases:
            here = frame
    return [*found, Target(TargetKind.OPEN, inverse(here))]


# --- Move a chain of links so that its joint axes coincide with those of another chain
#
# The joint axes are the z axes of frames ``(joints, L, 4, 4)``, where L is the number of samples.
#
# The base frame of a chain is free. Both chains have the same joint values. The rotation follows
# from the directions of the axes, then the translation from their positions. If the axes do not
# determine the transform (all are parallel, for example), one of the possible transforms is
# returned.


_EACH, _LAST = slice(None), slice(-1, None)


def align_axes(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """Return the transform ``(L, 4, 4)`` that best moves the axes ``source`` to ``target``.

    Both are ``(joints, L, 4, 4)``, where L is the number of samples. Only the direction of a
    ``sliding`` axis matters.
    """
    aligned: Matrices = _aligned(source, target, sliding, _LAST)[0]
    return aligned


def align_first_axes(source: Matrices, target: Matrices, sliding: NDArray[np.bool_]) -> Matrices:
    """Return the transforms that align the first 1, 2, … n axes: ``(n, samples, 4, 4)``."""
    return _aligned(source, target, sliding, _EACH)


def _aligned(
    source: Matrices, target: Matrices, sliding: NDArray[np.bool_], numbers: slice
) -> Matrices:
    # Aligns the first 1, 2, … n axes, or only a slice of these numbers: (m, L, 4, 4).
    known = _known_to_first(len(source))[numbers]
    rotation = _bases(target, sliding, known) @ np.swapaxes(_bases(source, sliding, known), -1, -2)
    transform = identity(rotation.shape[:2])
    transform[..., :3, :3] = rotation
    transform[..., :3, 3] = _translations(source, target, rotation, sliding, numbers)
    return transform


def _bases(axes: Matrices, sliding: NDArray[np.bool_], known: NDArray[np.bool_]) -> Matrices:
    # Right-handed bases (m, L, 3, 3) that are fixed to the known axes. z is along the first axis. x
    # points in the direction of the first axis that is not parallel to z, or else to the first
    # parallel axis at another place.
    z = axes[0, :, :3, 2]
    directions = axes[:, :, :3, 2]
    # Points are relative to the first revolute axis.
    points = axes[..., :3, 3] - axes[np.argmin(sliding), :, :3, 3]
    points = np.where(sliding[:, None, None], 0.0, points)
    any_x = np.eye(3)[np.argmin(np.abs(z), axis=-1)]
    across = np.concatenate([directions, points, any_x[None]])
    across = across - (across * z).sum(axis=-1, keepdims=True) * z
    length = np.sqrt((across * across).sum(axis=-1))
    least = length.min(axis=-1)
    # With rounded numbers, parallel axes may be slightly tilted, so nearly parallel ones come last.
    trust = 2 * (least > NOT_PARALLEL_BY_ROUNDING) + 2 * (least > CLEARLY_NOT_PARALLEL)
    trust[-1] = 1
    chosen = np.where(known, trust, -1).argmax(axis=1)
    x = across[chosen] / length[chosen][..., None]
    z = np.broadcast_to(z, x.shape)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def _known_to_first(joints: int) -> NDArray[np.bool_]:
    # A mask (n, 2 n + 1); row k is True for what the first k + 1 axes determine. The columns are
    # the n directions, the n points, and an arbitrary x, which is always True.
    first = np.tri(joints, dtype=np.bool_)
    return np.concatenate([first, first, np.ones((joints, 1), np.bool_)], axis=1)


def _translations(
    source: Matrices,
    target: Matrices,
    rotation: Matrices,
    sliding: NDArray[np.bool_],
    numbers: slice,
) -> Numbers:
    # The shifts (m, L, 3) that best move the revolute source axes to the target axes. With u along
    # an axis and p from a point of the rotated source axis to one of the target axis, the shift
    # minimises Σ |(1 − u uᵀ)(p − shift)|².
    u = target[..., :3, 2]
    projection = np.eye(3) - u[..., :, None] * u[..., None, :]
    projection[sliding] = 0.0
    turned = (rotation[:, None] @ source[..., :3, 3, None])[..., 0]
    p = target[..., :3, 3] - turned
    first = np.tri(len(source))[numbers, ..., None, None]
    left = projection.cumsum(axis=0)[numbers]
    right = ((projection @ p[..., None])[..., 0] * first).sum(axis=1)
    return np.asarray((np.linalg.pinv(left, hermitian=True) @ right[..., None])[..., 0])
