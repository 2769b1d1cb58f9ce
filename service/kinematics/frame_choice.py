"""The valid table nearest to the one that was written.

Denavit-Hartenberg tables are not unique. A chain is T(q) = C_0 M_1(q_1) C_1 … M_n(q_n) C_n with
constant links C_i. Two tables describe one mechanism if and only if constant transforms g_i exist
with C_i(written) = g_i⁻¹ C_i(reference) g_{i+1}, where g_i keeps joint axis i. So the rows are
walked from the base; ``g`` is the pose of the writer's frame in the reference's. At each row every
value that it could have had under the choices made so far is held against what was written: a wrong
cell costs 1, a departure from the reference's own choice a little, so that an uncompensated shift
is blamed where it was made and not where it surfaces. The cheapest few hypotheses are kept.

Shapes: H hypotheses, N their continuations, L samples; a row is ``(4, L)`` in the column
order a, α, d, θ; angles in radians.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.kinematics.base_freedom import BaseFreedom
from service.kinematics.candidate_rows import Place, candidates, misses, positions
from service.kinematics.chain import ALPHA, THETA, A, D
from service.kinematics.chain_match import SAME, Nearest, Stop, WrittenRow, senses_of
from service.kinematics.dh import standard_link
from service.kinematics.transforms import Matrices, Numbers, identity, inverse, rot_x

BEAM = 8
CONTINUATIONS = 20
# A hypothesis this far behind the best is given up: it would take a table with as many more slips.
BEHIND = 2.5

# A cell may be off by what rounding does to a number of the robot's own size, and no more.
LARGEST_ANGLE = 4.0
LARGEST_LENGTH = 1.5

# What a hypothesis costs. A cell that the table has no room for cannot be blamed on a slip, so that
# a reading which needs it is a last resort.
WRONG_CELL = 1.0
NO_SUCH_CELL = 3.0
UNREACHABLE = 3.0
TURNED_OVER = 0.010
TURNED_ABOUT = 0.004
MOVED = 0.020

_Way = tuple[tuple[Numbers, Matrices, int], ...]


@dataclass(frozen=True, slots=True)
class _Beam:
    """H hypotheses: the frame reached, the cost, and the way there."""

    pose: Matrices
    cost: Numbers
    ways: list[_Way]


def nearest_table(
    written: Sequence[WrittenRow],
    stops: Sequence[Stop],
    length_scale: float,
    *,
    base_given: bool = True,
    directions_given: bool = True,
) -> Nearest:
    """The valid table nearest to ``written``, whose i-th row leads to the i-th of ``stops``.

    ``base_given`` says that frame 0 is the reference's. ``directions_given`` says that each joint's
    positive sense is, so that a z axis turned over asks for a variable with the opposite sign.
    """
    samples = written[0].own.shape[-1]
    if base_given:
        beam, freedom = _Beam(identity((1, samples)), np.zeros(1), [()]), BaseFreedom()
        remaining = list(zip(written, stops, strict=True))
    else:
        beam, freedom = _from_free_base(written[0], stops[0])
        remaining = list(zip(written[1:], stops[1:], strict=True))
    for row, stop in remaining:
        beam = _advanced(beam, row, stop, length_scale, directions_given, freedom)
        if stop.reference is not None and stop.rebases and not freedom.spent:
            freedom = freedom.beyond(stop.reference, stop.place, length_scale)
    best = int(np.argmin(beam.cost))
    rows, poses, senses = zip(*beam.ways[best], strict=True)
    return Nearest(rows, senses, poses, float(beam.cost[best]))


def _from_free_base(first: WrittenRow, stop: Stop) -> tuple[_Beam, BaseFreedom]:
    """On the first axis, z either way: what leads there from a free base is right as it stands."""
    samples = first.own.shape[-1]
    poses = np.stack([identity((samples,)), rot_x(np.full(samples, np.pi))])
    own = np.nan_to_num(first.own)
    ways: list[_Way] = [((own, pose, sense),) for pose, sense in zip(poses, (1, -1), strict=True)]
    beam = _Beam(poses, np.array([0.0, TURNED_OVER]), ways)
    return beam, BaseFreedom.on_first_axis(stop.place is Place.PRISMATIC, samples)


@dataclass(frozen=True, slots=True)
class _Continuations:
    """N ways to go on: whose each is, the row that leads there, and the cells of it.

    ``way`` is how far the frame must be moved along what is left of the base's freedom. ``missed``
    says that no row leads to the place.
    """

    parents: NDArray[np.int_]
    rows: Numbers
    way: Numbers
    missed: NDArray[np.bool_]


def _advanced(
    beam: _Beam,
    row: WrittenRow,
    stop: Stop,
    length_scale: float,
    directions_given: bool,
    freedom: BaseFreedom,
) -> _Beam:
    """The cheapest hypotheses one row further on."""
    on = _continuations(beam, row, stop, length_scale, freedom)
    told = freedom.as_written(on.rows, row.own)
    wrong = _wrong_cells(row, told, length_scale)
    if row.variable is not None and directions_given:
        wrong[:, row.variable] |= row.sense * senses_of(beam.pose)[on.parents] < 0
    wrong |= row.spoiled
    cost = beam.cost[on.parents] + WRONG_CELL * (wrong & row.judged).sum(axis=1)
    cost += NO_SUCH_CELL * (wrong & row.absent).sum(axis=1) + UNREACHABLE * on.missed
    kept = np.argsort(cost, kind="stable")[:CONTINUATIONS]
    kept = kept[cost[kept] <= cost[kept[0]] + BEHIND]
    parents, rows, told, cost = on.parents[kept], on.rows[kept], told[kept], cost[kept]
    pose = _moved(beam.pose[parents], freedom, on.way[kept]) @ standard_link(*rows.swapaxes(0, 1))
    if stop.reference is not None and stop.rebases:
        pose = inverse(stop.reference) @ pose
        if freedom.anywhere:
            pose[..., :3, 3] = 0.0
        cost = cost + departure(pose, length_scale)
    elif stop.reference is not None:
        cost = cost + departure(inverse(stop.reference) @ pose, length_scale)
    kept = _distinct(pose, cost, length_scale)
    senses = senses_of(pose)
    return _Beam(
        pose[kept],
        cost[kept],
        [(*beam.ways[parents[i]], (told[i], pose[i], int(senses[i]))) for i in kept],
    )


def _moved(pose: Matrices, freedom: BaseFreedom, way: Numbers) -> Matrices:
    """Frames moved by ``way`` ``(N, L)`` along what is left of the base's freedom."""
    if freedom.slide is None:
        return pose
    moved = pose.copy()
    moved[..., :3, 3] += way[..., None] * freedom.slide
    return moved


def _continuations(
    beam: _Beam, row: WrittenRow, stop: Stop, length_scale: float, freedom: BaseFreedom
) -> _Continuations:
    """Every row that the hypotheses allow."""
    if stop.reference is None:
        rows = np.broadcast_to(np.nan_to_num(row.own), (len(beam.pose), *row.own.shape))
        nowhere = np.zeros((len(rows), rows.shape[-1]))
        return _Continuations(np.arange(len(rows)), rows, nowhere, np.zeros(len(rows), np.bool_))
    target = inverse(beam.pose) @ stop.reference
    classes = positions(target, length_scale)
    found = []
    for position in sorted(set(classes.tolist())):
        members = np.flatnonzero(classes == position)
        here = target[members]
        offered = candidates(here, row.own, stop.place, length_scale)
        parents = np.repeat(members, offered.shape[1])
        rows = offered.reshape(-1, *offered.shape[2:])
        if freedom.slide is None and not freedom.anywhere:
            ways = [(rows, np.zeros((len(rows), rows.shape[-1])))]
        else:
            step = np.ones(here.shape[:2])
            beyond = inverse(_moved(beam.pose[members], freedom, step)) @ stop.reference
            shifted = candidates(beyond, row.own, stop.place, length_scale)
            # One step aside the axes may lie differently; then there is nothing to compare with.
            shifted = shifted if shifted.shape == offered.shape else offered
            ways = freedom.spend(rows, shifted.reshape(rows.shape), row.own)
        for spent, way in ways:
            if stop.place is Place.TOOL:
                reached = inverse(_moved(beam.pose[parents], freedom, way)) @ stop.reference
                missed = misses(reached, length_scale) & (not freedom.anywhere)
            else:
                missed = np.zeros(len(parents), np.bool_)
            found.append((parents, spent, way, missed))
    return _Continuations(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def _wrong_cells(row: WrittenRow, rows: Numbers, length_scale: float) -> NDArray[np.bool_]:
    """Which cells of the written row differ from each of ``rows``: ``(N, 4)``."""
    error = np.abs(row.own - rows)
    turns = error[:, [ALPHA, THETA]] / (2 * np.pi)
    error[:, [ALPHA, THETA]] = 2 * np.pi * np.abs(turns - np.round(turns))
    size = np.sqrt(np.mean(rows * rows, axis=-1))
    scale = np.ones(4)
    scale[[A, D]] = length_scale
    largest = np.full(4, LARGEST_ANGLE)
    largest[[A, D]] = LARGEST_LENGTH * length_scale
    with np.errstate(invalid="ignore"):
        bounded = np.minimum(size, largest)
        right = error.max(axis=-1) <= np.maximum(row.tolerance * bounded, 1e-9 * scale)
    return np.asarray(~right)


def departure(pose: Matrices, length_scale: float) -> Numbers:
    """What the writer's own choice of frame costs: next to nothing, but not nothing."""
    cost = np.where(pose[:, 0, 2, 2] < 0, TURNED_OVER, 0.0)
    cost += np.where(pose[:, 0, 0, 0] < 0, TURNED_ABOUT, 0.0)
    turned = np.abs(pose[:, :, 1, 0]).max(axis=-1) > SAME
    moved = np.abs(pose[:, :, :3, 3]).max(axis=(-1, -2)) > SAME * length_scale
    return np.asarray(cost + MOVED * (turned.astype(np.float64) + moved))


def _distinct(pose: Matrices, cost: Numbers, length_scale: float) -> NDArray[np.int_]:
    """The cheapest BEAM hypotheses of different frames; of equal frames the cheapest is enough."""
    order = np.argsort(cost, kind="stable")
    frames = pose[order, 0, :3].reshape(len(order), -1)
    apart = np.abs(frames[:, None] - frames[None]).max(axis=-1) > 1e-6 * max(1.0, length_scale)
    earlier = np.tri(len(order), k=-1, dtype=np.bool_)
    repeated = (~apart & earlier).any(axis=1)
    return np.asarray(order[~repeated][:BEAM])
