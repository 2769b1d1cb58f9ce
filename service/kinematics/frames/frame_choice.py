"""Find the correct table that is nearest to the student's table.

Students may choose their own frames. The search goes from the base to the tool, and keeps only the
best candidates.

Shapes: H candidates, N ways to continue them, L samples; a row is ``(4, L)`` with the columns a, α,
d, θ.
"""

# chain_match explains when two tables describe one mechanism. Each written row is compared with all
# rows that are valid for the frames chosen so far. A wrong cell costs 1. Each further wrong cell in
# the same row costs less, so that one wrong row is cheaper than errors in several rows. A frame
# other than the reference's frame has a small cost, so that an uncompensated shift is found in the
# row where it was made. The search is a beam search.
#
# Angles are in radians. A relative pose is the pose of the writer's frame in the reference's.

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.kinematics.chain import ALPHA, THETA
from service.kinematics.dh import standard_link
from service.kinematics.dh_row import is_unreachable
from service.kinematics.frames.base_freedom import BaseFreedom
from service.kinematics.frames.candidate_rows import TargetKind, axis_relations, candidate_rows
from service.kinematics.frames.chain_match import ChainMatch, RowConstants, Target, joint_signs_of
from service.kinematics.tolerances import (
    EXACT_CELL,
    ROUNDED_CELL,
    SAME_HYPOTHESIS,
    SAME_POSE,
)
from service.kinematics.transforms import Matrices, Numbers, identity, inverse, rot_x

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
    for row, target in remaining:
        beam = _next_beam(beam, row, target, length_scale, directions_given, freedom, z_ends_rows)
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
    # pose (N, L, 4, 4) are the relative poses of the frames. The cost is not 0.
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
