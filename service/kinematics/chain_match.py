"""Walking a written table along a reference chain: where each row leads, and whether it gets there.

A chain is T(q) = C_0 M_1(q_1) C_1 … M_n(q_n) C_n with constant links C_i. Two tables describe one
mechanism if and only if constant transforms g_i exist with C_i(written) = g_i⁻¹ C_i(reference)
g_{i+1}, where g_i keeps joint axis i. ``g`` is the pose of the writer's frame in the reference's.

Shapes: L samples; a row is ``(4, L)`` in the column order a, α, d, θ; angles in radians.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.kinematics.candidate_rows import Place
from service.kinematics.dh import standard_link
from service.kinematics.transforms import Matrices, Numbers, identity, inverse

SAME = 1e-7


@dataclass(frozen=True, slots=True)
class Stop:
    """A place that a row leads to.

    ``reference`` is the transform ``(L, 4, 4)`` to this place's frame from that of the last joint,
    both the reference's; None for a fixed frame that the reference does not have.
    """

    place: Place
    reference: Matrices | None

    @property
    def rebases(self) -> bool:
        """Whether the reference has a frame here that what follows is seen from."""
        return self.reference is not None and self.place is not Place.FIXED


@dataclass(frozen=True, slots=True)
class WrittenRow:
    """The constants of a row as written.

    ``own`` is ``(4, L)``, NaN where there is no usable number; ``judged`` ``(4,)`` says which cells
    can be right or wrong; ``spoiled`` which are wrong whatever the frames; ``absent`` which cells
    the table has no room for (they are 0); ``tolerance`` ``(4,)`` how much of its size each may be
    off, because it was rounded. ``variable`` is the column of the variable of the joint
    that the row starts from, None where it starts from none; ``sense`` the sign that it was written
    with: +1, −1, or 0 where it tells nothing.
    """

    own: Numbers
    judged: NDArray[np.bool_]
    spoiled: NDArray[np.bool_]
    absent: NDArray[np.bool_]
    tolerance: Numbers
    variable: int | None
    sense: int


@dataclass(frozen=True, slots=True)
class Nearest:
    """The valid table nearest to what was written.

    ``rows`` is what each row should be, ``(4, L)`` each; ``senses`` the sign that each stop's joint
    variable should have; ``poses`` where the writer's frame at each stop lies in the reference's,
    ``(L, 4, 4)`` each; ``cost`` what the way there cost.
    """

    rows: tuple[Numbers, ...]
    senses: tuple[int, ...]
    poses: tuple[Matrices, ...]
    cost: float


def valid_as_it_stands(
    written: Sequence[WrittenRow],
    stops: Sequence[Stop],
    length_scale: float,
    *,
    directions_given: bool = True,
    start: Matrices | None = None,
) -> Nearest | None:
    """The table itself where nothing in it is wrong, found without a search; else None.

    ``start`` as in ``followed``.
    """
    if any(row.spoiled.any() for row in written):
        return None
    own = np.array([row.own for row in written])
    senses = np.array([row.sense if directions_given else 0 for row in written])
    valid, poses = followed(own[None], senses[None], stops, length_scale, start=start)
    if not valid[0]:
        return None
    return Nearest(
        rows=tuple(own),
        senses=tuple(int(senses_of(pose)[0]) for pose in poses),
        poses=tuple(pose[0] for pose in poses),
        cost=0.0,
    )


def followed(
    own: Numbers,
    senses: NDArray[np.int_],
    stops: Sequence[Stop],
    length_scale: float,
    tolerance: float = SAME,
    start: Matrices | None = None,
) -> tuple[NDArray[np.bool_], Matrices]:
    """Which of many tables are valid as they stand, without any search.

    ``own`` is ``(tables, rows, 4, L)``, ``senses`` ``(tables, rows)`` as in WrittenRow, 0 where the
    direction is free. ``start`` ``(L, 4, 4)`` is where the writer's frame 0 lies in the
    reference's, None for the same place. Returns ``(tables,)``, and where the writer's frame at
    each stop lies in the reference's, ``(rows, tables, L, 4, 4)``. NaN makes a table invalid.
    """
    count = own.shape[-1]
    links = standard_link(*np.moveaxis(own, 2, 0))
    pose = identity((len(own), count))
    if start is not None:
        pose[:] = start
    poses = np.empty((len(stops), *pose.shape))
    for i, stop in enumerate(stops):
        pose = pose @ links[:, i]
        if stop.reference is not None and stop.rebases:
            pose = inverse(stop.reference[:count]) @ pose
        poses[i] = pose
    valid = np.ones(len(own), dtype=np.bool_)
    for i, stop in enumerate(stops):
        valid &= _off_place(poses[i], stop, length_scale) <= tolerance
        if i > 0:
            valid &= senses[:, i] * senses_of(poses[i - 1]) >= 0
    return valid, poses


def _off_place(pose: Matrices, stop: Stop, length_scale: float) -> Numbers:
    """By how much frames ``(T, L, 4, 4)`` miss what their place demands: ``(T,)``."""
    missed: Numbers = np.abs(pose[:, :, :2, 2]).max(axis=(1, 2))
    if stop.place in (Place.FIXED, Place.OPEN):
        return np.where(np.isnan(missed), np.nan, 0.0)
    if stop.place is not Place.PRISMATIC:
        missed = np.maximum(missed, np.abs(pose[:, :, :2, 3]).max(axis=(1, 2)) / length_scale)
    if stop.place is Place.TOOL:
        missed = np.maximum(missed, np.abs(pose - np.eye(4)).max(axis=(1, 2, 3)))
    return missed


def senses_of(pose: Matrices) -> NDArray[np.int_]:
    """+1 where the writer's z points the way of the reference's, −1 where it is turned over."""
    return np.where(pose[:, 0, 2, 2] > 0, 1, -1)
